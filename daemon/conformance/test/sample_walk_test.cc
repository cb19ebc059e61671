// SPDX-License-Identifier: Apache-2.0
#include "daemon/conformance/sample_walk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <set>

#include "daemon/host/check_output.h"
#include "gaitd/sdk/views.h"
#include "walking/test/atlas.h"

namespace gaitd::daemon {
namespace {

using testing::atlas;

TEST(SampleWalk, StandsWalksAndStandsAgain) {
  SampleWalk walk(atlas());
  std::set<int> phases, steps;
  int ticks = 0;
  while (walk.tick()) {
    phases.insert(walk.inputs().gait.phase);
    steps.insert(walk.inputs().gait.step_index);
    ++ticks;
  }
  EXPECT_EQ(phases.size(), 3u);
  EXPECT_TRUE(steps.contains(3));  // two steps and the closing one
  EXPECT_GT(ticks, 3000);
  EXPECT_LT(ticks, 8000);
  EXPECT_EQ(walk.inputs().gait.phase, GAITD_PHASE_STAND);
  EXPECT_GT(walk.inputs().robot.com[0], 0.15 * atlas().nominal_com_height);
}

TEST(SampleWalk, FitsTogether) {
  SampleWalk walk(atlas());
  const double weight = atlas().total_mass * atlas().gravity;
  Eigen::VectorXd last = sdk::head(atlas().nominal_position, atlas().joint_count);
  while (walk.tick()) {
    const InputSet& in = walk.inputs();
    ASSERT_EQ(output_error(in.robot, atlas().joint_count), nullptr) << in.time.tick;
    ASSERT_EQ(output_error(in.adjustment, 0), nullptr);
    // The ICP is near its plan, feet on the ground stay where the gait has them.
    const Eigen::Vector2d error = sdk::view(in.robot.icp) - sdk::view(in.plan.icp);
    ASSERT_LT(error.norm(), 0.05) << in.time.tick;
    for (int side = 0; side < GAITD_MAX_FEET; ++side) {
      if (in.gait_before.footholds[side].contact == GAITD_CONTACT_NONE) continue;
      const Eigen::Vector3d gap = sdk::view(in.robot.feet[side].position) -
                                  sdk::view(in.gait_before.footholds[side].pose.position);
      ASSERT_LT(gap.norm(), 0.01) << in.time.tick;
    }
    ASSERT_NEAR(in.robot.feet[0].normal_force + in.robot.feet[1].normal_force, weight, 1e-6);
    const Eigen::VectorXd q = sdk::head(in.robot.joint_position, atlas().joint_count);
    ASSERT_LT((q - last).cwiseAbs().maxCoeff(), 0.02) << in.time.tick;
    last = q;
  }
}

TEST(SampleWalk, IsTheSameEveryTime) {
  SampleWalk a(atlas()), b(atlas());
  while (a.tick()) {
    ASSERT_TRUE(b.tick());
    ASSERT_EQ(std::memcmp(&a.inputs().robot, &b.inputs().robot, sizeof(GaitdRobotState)), 0);
    ASSERT_EQ(std::memcmp(&a.inputs().sensors, &b.inputs().sensors, sizeof(GaitdSensors)), 0);
  }
  EXPECT_FALSE(b.tick());
}

TEST(SampleWalk, SpoilsNumbersButNoCounts) {
  SampleWalk walk(atlas());
  walk.tick();
  InputSet set = walk.inputs();
  set.spoil(std::nan(""));
  EXPECT_TRUE(std::isnan(set.sensors.joints[0].position));
  EXPECT_TRUE(std::isnan(set.robot.icp[1]));
  EXPECT_EQ(set.sensors.joint_count, atlas().joint_count);
  EXPECT_EQ(set.objectives.task_count, walk.inputs().objectives.task_count);
}

}  // namespace
}  // namespace gaitd::daemon
