// SPDX-License-Identifier: Apache-2.0
#include "ros2/velocity_drive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>

namespace gaitd::ros2 {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;

struct Request {
  std::string method;
  json params;
  VelocityDrive::Done done;
};

class VelocityDriveTest : public ::testing::Test {
 protected:
  VelocityDrive make(bool auto_mode = false) {
    VelocityDrive drive(
        {.timeout = milliseconds(500), .auto_mode = auto_mode, .session = 7},
        [this](const std::string& method, const json& params, VelocityDrive::Done done) {
          requests_.push_back({method, params, std::move(done)});
        });
    drive.set_robot("standing", "walk-straight");
    return drive;
  }
  // The oldest request, answered.
  json answer(const json& result = {{"result", {{"note", nullptr}}}}) {
    EXPECT_FALSE(requests_.empty());
    if (requests_.empty()) return {};
    const Request request = requests_.front();
    requests_.pop_front();
    request.done(result);
    return request.params;
  }
  static json refusal(const std::string& text) { return {{"error", {{"message", text}}}}; }
  // Messages every 50 ms, answers at once; gives the requests.
  std::vector<json> stream(VelocityDrive* drive, const Velocity& velocity, int count) {
    std::vector<json> sent;
    for (int i = 0; i < count; ++i) {
      drive->on_velocity(velocity, now_);
      while (!requests_.empty()) sent.push_back(answer());
      now_ += milliseconds(50);
      drive->tick(now_);
      while (!requests_.empty()) sent.push_back(answer());
    }
    return sent;
  }

  std::deque<Request> requests_;
  VelocityDrive::Time now_{std::chrono::hours(1)};
};

TEST_F(VelocityDriveTest, BeginsAtOnceAndRenewsTenTimesASecond) {
  VelocityDrive drive = make();
  const auto sent = stream(&drive, {0.3, -0.1, 0.2}, 20);
  ASSERT_GE(sent.size(), 9u);
  ASSERT_LE(sent.size(), 11u);
  EXPECT_EQ(
      sent[0],
      (json{{"forward", 0.3}, {"lateral", -0.1}, {"turn", 0.2}, {"session", 7}, {"renew", false}}));
  EXPECT_EQ(sent[1]["renew"], true);
  EXPECT_TRUE(drive.driving());
}

TEST_F(VelocityDriveTest, EndsTheDriveOnceWhenMessagesCease) {
  VelocityDrive drive = make();
  stream(&drive, {0.3, 0.0, 0.0}, 4);
  std::vector<json> sent;
  const auto silent = now_;
  while (now_ - silent < milliseconds(3000)) {
    now_ += milliseconds(20);
    drive.tick(now_);
    while (!requests_.empty()) sent.push_back(answer());
    if (now_ - silent > milliseconds(460)) {
      EXPECT_FALSE(drive.driving());
    }
  }
  ASSERT_FALSE(sent.empty());
  EXPECT_LE(sent.size(), 6u);
  for (std::size_t i = 0; i + 1 < sent.size(); ++i) {
    EXPECT_EQ(sent[i]["forward"], 0.3);
    EXPECT_EQ(sent[i]["renew"], true);
  }
  EXPECT_EQ(sent.back(), (json{{"session", 7}, {"end", true}}));
}

TEST_F(VelocityDriveTest, ZeroDoesNotTakeTheRobotAndEndsADrive) {
  VelocityDrive drive = make();
  EXPECT_TRUE(stream(&drive, {}, 10).empty());
  stream(&drive, {0.3, 0.0, 0.0}, 4);
  const auto sent = stream(&drive, {}, 10);
  ASSERT_EQ(sent.size(), 1u);
  EXPECT_EQ(sent[0], (json{{"session", 7}, {"end", true}}));
  EXPECT_FALSE(drive.driving());
}

TEST_F(VelocityDriveTest, WhatIsNoNumberIsRefusedAndKeepsNothingAlive) {
  VelocityDrive drive = make();
  EXPECT_TRUE(stream(&drive, {NAN, 0.0, 0.0}, 5).empty());
  EXPECT_EQ(drive.refused_messages(), 5u);
  drive.on_velocity({0.0, INFINITY, 0.0}, now_);
  EXPECT_NE(drive.trouble().find("finite"), std::string::npos);
  stream(&drive, {0.3, 0.0, 0.0}, 4);
  ASSERT_TRUE(drive.driving());
  stream(&drive, {0.3, 0.0, NAN}, 12);
  EXPECT_FALSE(drive.driving());
}

TEST_F(VelocityDriveTest, WhatIsBeyondTheRangeOfDriveIsBroughtIntoIt) {
  VelocityDrive drive = make();
  const auto sent = stream(&drive, {1e9, 0.0, -50.0}, 1);
  EXPECT_EQ(sent[0]["forward"], 3.0);
  EXPECT_EQ(sent[0]["turn"], -3.0);
}

TEST_F(VelocityDriveTest, WhatWasTakenAwayIsNotTakenBack) {
  VelocityDrive drive = make();
  stream(&drive, {0.3, 0.0, 0.0}, 3);
  now_ += milliseconds(100);
  drive.on_velocity({0.3, 0.0, 0.0}, now_);
  answer(refusal("drive: session 9 drives"));
  EXPECT_EQ(drive.trouble(), "drive: session 9 drives");
  EXPECT_TRUE(stream(&drive, {0.3, 0.0, 0.0}, 100).empty());
  stream(&drive, {}, 1);  // the stick is let go
  const auto sent = stream(&drive, {0.3, 0.0, 0.0}, 1);
  ASSERT_EQ(sent.size(), 1u);
  EXPECT_EQ(sent[0]["renew"], false);
}

TEST_F(VelocityDriveTest, InModeStandItSaysWhyAndTriesAgain) {
  VelocityDrive drive = make();
  drive.set_robot("standing", "stand");
  drive.on_velocity({0.3, 0.0, 0.0}, now_);
  answer(refusal("drive: mode is stand"));
  EXPECT_EQ(drive.trouble(), "drive: mode is stand");
  drive.set_robot("standing", "walk-bent");
  const auto sent = stream(&drive, {0.3, 0.0, 0.0}, 30);
  ASSERT_FALSE(sent.empty());
  EXPECT_EQ(sent[0]["renew"], false);
  EXPECT_TRUE(drive.trouble().empty());
}

TEST_F(VelocityDriveTest, SetsTheModeOnlyWhereItIsAskedTo) {
  VelocityDrive drive = make(true);
  drive.set_robot("standing", "stand");
  drive.on_velocity({0.3, 0.0, 0.0}, now_);
  ASSERT_EQ(requests_.size(), 1u);
  EXPECT_EQ(requests_[0].method, "mode");
  EXPECT_EQ(answer(), (json{{"mode", "walk-straight"}}));
  now_ += milliseconds(20);
  drive.tick(now_);
  ASSERT_EQ(requests_.size(), 1u);
  EXPECT_EQ(requests_[0].method, "drive");
}

TEST_F(VelocityDriveTest, ARobotThatStandsUpAgainDoesNotWalkOff) {
  VelocityDrive drive = make();
  drive.set_robot("fault", "walk-straight");
  EXPECT_TRUE(stream(&drive, {0.3, 0.0, 0.0}, 10).empty());
  EXPECT_NE(drive.trouble().find("fault"), std::string::npos);
  drive.set_robot("standing", "walk-straight");
  EXPECT_TRUE(stream(&drive, {0.3, 0.0, 0.0}, 100).empty());
  drive.hold("the robot was stopped by /e_stop");
  now_ += milliseconds(600);
  drive.tick(now_);
  EXPECT_EQ(stream(&drive, {0.3, 0.0, 0.0}, 1).size(), 1u);
}

TEST_F(VelocityDriveTest, AnAnswerThatDoesNotComeEndsTheDrive) {
  VelocityDrive drive = make();
  drive.on_velocity({0.3, 0.0, 0.0}, now_);
  for (int i = 0; i < 60; ++i) {
    now_ += milliseconds(50);
    drive.on_velocity({0.3, 0.0, 0.0}, now_);
  }
  EXPECT_EQ(requests_.size(), 1u) << "requests pile up";
  EXPECT_FALSE(drive.driving());
  EXPECT_NE(drive.trouble().find("does not answer"), std::string::npos);
  answer(refusal("late"));
  EXPECT_NE(drive.trouble().find("does not answer"), std::string::npos);
}

}  // namespace
}  // namespace gaitd::ros2
