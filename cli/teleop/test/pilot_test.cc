// SPDX-License-Identifier: Apache-2.0
// What is sent to gaitd, and above all what no longer is.
#include "cli/teleop/pilot.h"

#include <gtest/gtest.h>

#include "cli/rpc_client.h"

namespace gaitd::cli::teleop {
namespace {

using daemon::RpcError;
using nlohmann::json;
using std::chrono::milliseconds;

constexpr Speed kAhead{0.3, 0.0, 0.0};

json status(const std::string& state, const std::string& mode = "walk-straight") {
  return {{"state", state}, {"mode", mode}, {"paused", false}, {"stale", false}};
}

json accepted(const char* note = nullptr) {
  return {{"accepted", true}, {"tick", 1}, {"note", note == nullptr ? json() : json(note)}};
}

class PilotTest : public ::testing::Test {
 protected:
  PilotTest() { pilot_.take_status(status("standing")); }

  // One round, `ms` after the one before.
  std::vector<Request> round(bool held, int ms = 20) {
    now_ += milliseconds(ms);
    return pilot_.act(held ? kAhead : Speed{}, held, now_);
  }
  // Holds for a while and lets gaitd take every velocity; how many there were.
  int hold(int ms) {
    int count = 0;
    for (int i = 0; i < ms; i += 20) {
      for (const Request& request : round(true)) {
        EXPECT_EQ(request.method, "drive");
        pilot_.take_answer("drive", accepted());
        ++count;
      }
    }
    return count;
  }
  static bool is_stop(const std::vector<Request>& requests) {
    return requests.size() == 1 && requests[0].method == "drive" &&
           requests[0].params == json{{"session", 7}, {"end", true}};
  }

  static RpcError refusal(const char* reason) {
    return {daemon::rpc_code::kRefused, "drive: refused", {{"tick", 1}, {"reason", reason}}};
  }

  Pilot pilot_{7};
  Time now_ = Time{} + std::chrono::hours(1);
};

TEST_F(PilotTest, SendsNothingWhileNothingIsHeld) {
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(round(false).empty());
}

TEST_F(PilotTest, BeginsADriveAndRenewsItTenTimesASecond) {
  const auto first = round(true);
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(first[0].params["renew"], false);
  EXPECT_EQ(first[0].params["session"], 7);
  EXPECT_EQ(first[0].params["forward"], 0.3);
  pilot_.take_answer("drive", accepted());
  EXPECT_NEAR(hold(2000), 20, 1);
  const auto later = round(true, 100);
  ASSERT_EQ(later.size(), 1u);
  EXPECT_EQ(later[0].params["renew"], true);
}

TEST_F(PilotTest, LettingGoStopsOnceAndThenIsSilent) {
  hold(500);
  EXPECT_TRUE(is_stop(round(false)));
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(round(false).empty());
  const auto again = round(true);
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(again[0].params["renew"], false) << "the drive before is over";
}

TEST_F(PilotTest, GivesUpWhereNothingIsAnswered) {
  int sent = 0;
  for (int i = 0; i < 100; ++i) sent += static_cast<int>(round(true).size());
  EXPECT_EQ(sent, 5) << "what would arrive at last is older than drive.timeout";
}

TEST_F(PilotTest, LeavesTheModeStandByItself) {
  pilot_.take_status(status("standing", "stand"));
  const auto first = round(true);
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(first[0].method, "mode");
  EXPECT_EQ(first[0].params["mode"], "walk-straight");
  EXPECT_TRUE(round(true, 200).empty()) << "once";
  pilot_.take_answer("mode", accepted());
  EXPECT_NE(pilot_.message().find("walk-straight"), std::string::npos);
  ASSERT_EQ(round(true).size(), 1u);
}

TEST_F(PilotTest, SaysWhatIsMissingAndWantsTheHandOffFirst) {
  for (const char* state : {"disarmed", "fault", "readying", "testing"}) {
    pilot_.take_status(status(state));
    EXPECT_TRUE(round(true, 200).empty()) << state;
    EXPECT_FALSE(pilot_.message().empty()) << state;
    pilot_.take_status(status("standing"));
    EXPECT_TRUE(round(true, 200).empty()) << "the key was held before it could walk: " << state;
    round(false);
    EXPECT_EQ(round(true, 200).size(), 1u);
    EXPECT_TRUE(is_stop(round(false)));
    for (int i = 0; i < 2; ++i) pilot_.take_answer("drive", accepted());
  }
  json stale = status("standing");
  stale["stale"] = true;
  pilot_.take_status(stale);
  EXPECT_TRUE(round(true, 200).empty());
}

TEST_F(PilotTest, DoesNotFightWithWhoeverTakesTheRobotOver) {
  hold(500);
  round(true, 100);
  pilot_.take_answer("drive", refusal("taken_over"));
  EXPECT_TRUE(pilot_.bad());
  EXPECT_NE(pilot_.message().find("taken the robot over"), std::string::npos);
  for (int i = 0; i < 50; ++i) EXPECT_TRUE(round(true, 100).empty());
  // Keys that stutter are no decision.
  for (int i = 0; i < 10; ++i) {
    EXPECT_TRUE(round(false, 100).empty());
    EXPECT_TRUE(round(true, 400).empty());
  }
  for (int i = 0; i < 11; ++i) round(false, 100);
  const auto back = round(true);
  ASSERT_EQ(back.size(), 1u);
  EXPECT_EQ(back[0].params["renew"], false);
}

TEST_F(PilotTest, TellsASlowConnectionFromAnotherDriver) {
  hold(500);
  round(true, 100);
  pilot_.take_answer("drive", refusal("not_renewed"));
  EXPECT_NE(pilot_.message().find("slow"), std::string::npos) << pilot_.message();
  EXPECT_TRUE(round(true, 100).empty());
  round(false);
  EXPECT_EQ(round(true).size(), 1u);
}

TEST_F(PilotTest, ShowsNotesAndRefusals) {
  round(true);
  pilot_.take_answer("drive", accepted("slower than asked"));
  EXPECT_EQ(pilot_.message(), "slower than asked");
  EXPECT_FALSE(pilot_.bad());
  round(true, 100);
  pilot_.take_answer("drive", accepted());
  EXPECT_EQ(pilot_.message(), "");
  pilot_.take_answer("arm", RpcError{daemon::rpc_code::kRefused, "arm: not upright"});
  EXPECT_EQ(pilot_.message(), "arm: not upright");
  EXPECT_TRUE(pilot_.bad());
}

TEST_F(PilotTest, AStopNeedsTheHandOffBeforeItGoesOn) {
  hold(500);
  const auto stop = pilot_.press(Key::kStop, false);
  ASSERT_EQ(stop.size(), 1u);
  EXPECT_EQ(stop[0].method, "stop");
  EXPECT_TRUE(round(true, 200).empty());
  round(false);
  EXPECT_EQ(round(true, 200).size(), 1u);
}

TEST_F(PilotTest, DoesNotResetWhatIsBeingStopped) {
  EXPECT_TRUE(pilot_.press(Key::kReset, true).empty());
  ASSERT_EQ(pilot_.press(Key::kReset, false).size(), 1u);
  EXPECT_EQ(pilot_.press(Key::kArm, false)[0].method, "arm");
}

TEST_F(PilotTest, AfterALostConnectionNothingGoesOnByItself) {
  hold(500);
  pilot_.lose_connection("gaitd is gone");
  EXPECT_EQ(pilot_.message(), "gaitd is gone");
  EXPECT_TRUE(round(true, 200).empty());
  EXPECT_TRUE(pilot_.connection_lost());
  pilot_.take_status(status("standing"));
  EXPECT_FALSE(pilot_.connection_lost());
  EXPECT_TRUE(round(true, 200).empty());
  round(false);
  EXPECT_EQ(round(true, 200).size(), 1u);
}

TEST_F(PilotTest, EndsWithAStopOnlyIfItDrives) {
  EXPECT_TRUE(pilot_.finish().empty());
  hold(200);
  EXPECT_TRUE(is_stop(pilot_.finish()));
  EXPECT_TRUE(pilot_.finish().empty());
}

}  // namespace
}  // namespace gaitd::cli::teleop
