// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/stance_pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "gaitd/sdk/views.h"
#include "walking/test/synthetic_walk.h"

namespace gaitd::walking {
namespace {

using testing::atlas;
using testing::SyntheticWalk;

constexpr double kPeriod = 0.001;  // s

class StancePoseTest : public ::testing::Test {
 protected:
  StancePoseTest() {
    walk_.machine.set_mode(GAITD_MODE_WALK_BENT);
    walk_.tick();
  }
  void run(double seconds) {
    for (int i = 0; i < static_cast<int>(seconds / kPeriod); ++i)
      pose_.update(kPeriod, walk_.gait());
  }
  GaitdIcpPlan shifted() const {
    GaitdIcpPlan plan{};
    pose_.shift_plan(walk_.gait(), plan);
    return plan;
  }

  SyntheticWalk walk_;
  StancePose pose_{atlas()};
};

TEST_F(StancePoseTest, NothingIsMovedUntilItIsTold) {
  run(1.0);
  EXPECT_EQ(shifted().icp[0], 0.0);
  EXPECT_EQ(pose_.height(), 0.0);
  EXPECT_EQ(pose_.turn().w(), 1.0);
}

TEST_F(StancePoseTest, GoesThereWithoutAJerkAndStays) {
  PoseCommand command;
  command.shift[1] = 0.06;
  command.shift[2] = -0.08;
  command.turn[2] = 0.2;
  ASSERT_FALSE(pose_.command(command, walk_.gait()).refused());
  GaitdIcpPlan before = shifted();
  EXPECT_EQ(before.icp[1], 0.0);
  const double omega = walk_.gait().omega;
  for (int i = 0; i < 1500; ++i) {
    pose_.update(kPeriod, walk_.gait());
    const GaitdIcpPlan now = shifted();
    // A plan of the divergent component: its rate is omega times the way from the CMP to it.
    EXPECT_NEAR(now.icp_velocity[1], omega * (now.icp[1] - now.ecmp[1]), 1e-9);
    EXPECT_LT(std::abs(now.icp[1] - before.icp[1]), 3e-4) << i;
    before = now;
  }
  run(1.0);
  EXPECT_NEAR(shifted().icp[1], 0.06, 1e-12);
  EXPECT_NEAR(shifted().icp_velocity[1], 0.0, 1e-12);
  EXPECT_NEAR(pose_.height(), -0.08, 1e-12);
  EXPECT_NEAR(sdk::yaw_of(pose_.turn()), 0.2, 1e-12);
}

TEST_F(StancePoseTest, AWalkTakesItBack) {
  PoseCommand command;
  command.shift[0] = 0.05;
  ASSERT_FALSE(pose_.command(command, walk_.gait()).refused());
  run(2.0);
  ASSERT_FALSE(walk_.machine.walk({.steps = 2, .length = 0.1}).refused());
  walk_.tick();
  ASSERT_NE(walk_.gait().phase, GAITD_PHASE_STAND);
  EXPECT_TRUE(pose_.command(command, walk_.gait()).refused());
  run(0.9);
  EXPECT_EQ(shifted().icp[0], 0.0);
}

TEST_F(StancePoseTest, RefusesWhatTheFeetCannotHold) {
  const auto refusal = [&](const PoseCommand& command) {
    return std::string(pose_.command(command, walk_.gait()).message);
  };
  PoseCommand command;
  command.shift[0] = 0.12;
  EXPECT_NE(refusal(command).find("edge of the feet"), std::string::npos);
  command = {};
  command.shift[2] = 0.02;
  EXPECT_NE(refusal(command).find("pelvis.z"), std::string::npos);
  command = {};
  command.turn[1] = 0.5;
  EXPECT_NE(refusal(command).find("pelvis.pitch"), std::string::npos);
  command = {};
  command.shift[1] = std::nan("");
  EXPECT_FALSE(refusal(command).empty());
  run(1.0);
  EXPECT_EQ(shifted().icp[0], 0.0) << "a refusal changes nothing";
}

TEST_F(StancePoseTest, StraightLegsHaveNoHeight) {
  walk_.machine.set_mode(GAITD_MODE_WALK_STRAIGHT);
  walk_.tick();
  PoseCommand command;
  command.shift[2] = -0.05;
  EXPECT_TRUE(pose_.command(command, walk_.gait()).refused());
  command.shift[2] = 0.0;
  command.turn[0] = 0.1;
  EXPECT_FALSE(pose_.command(command, walk_.gait()).refused());
}

}  // namespace
}  // namespace gaitd::walking
