// SPDX-License-Identifier: Apache-2.0
#include "foot_feedback.h"

#include <gtest/gtest.h>

#include <memory>

#include "gaitd/dynamics/dynamics.h"
#include "gaitd/sdk/views.h"
#include "layer_inputs.h"
#include "walking/test/tick.h"

namespace gaitd::plugins {
namespace {

using testing::atlas;
using testing::kDt;

constexpr double kGain = 20.0;  // 1/s

// Atlas stands on both feet; the controller wants the CoP in the middle of each sole.
struct FeedbackBench {
  explicit FeedbackBench(const GaitdModel& model = atlas()) : dynamics(model), feedback(model) {
    robot = testing::standing_state(atlas());
    dynamics.update(robot);
    for (int side : {GAITD_LEFT, GAITD_RIGHT}) {
      const GaitdFoot& foot = atlas().feet[side];
      for (int i = 0; i < foot.point_count; ++i)
        add_point(side, {foot.points[i][0], foot.points[i][1], 0.0});
      load(side, {0.0, 0.0});
      wanted.foot_wrench[side][5] = half_weight();
    }
  }
  static double half_weight() { return 0.5 * atlas().total_mass * atlas().gravity; }
  void add_point(int side, const Eigen::Vector3d& in_sole) {
    const GaitdFoot& foot = atlas().feet[side];
    GaitdContactPoint& c = objectives->contacts[objectives->contact_count++];
    c.side = side;
    c.body = foot.body;
    sdk::view(c.point) = Eigen::Vector3d(sdk::view(foot.sole.origin) +
                                         sdk::quaternion(foot.sole.orientation) * in_sole);
  }
  void load(int side, const Eigen::Vector2d& cop) {
    GaitdFootState& foot = robot.feet[side];
    foot.cop_valid = 1;
    sdk::view(foot.cop) = cop;
    foot.wrench[5] = half_weight();
  }
  void want(int side, const Eigen::Vector2d& cop) {  // the soles lie along the world
    wanted.foot_wrench[side][0] = cop.y() * half_weight();
    wanted.foot_wrench[side][1] = -cop.x() * half_weight();
  }
  // Torque of a joint after so many ticks.
  double torque(int joint, int ticks, double gain = kGain) {
    for (int i = 0; i < ticks; ++i) {
      *commands = {};
      feedback.update(kDt, gain, dynamics, robot, *objectives, wanted, *commands);
    }
    return commands->joints[joint].torque;
  }

  dynamics::Dynamics dynamics;
  FootFeedback feedback;
  GaitdRobotState robot{};
  GaitdWbcInfo wanted{};
  std::unique_ptr<GaitdObjectives> objectives = std::make_unique<GaitdObjectives>();
  std::unique_ptr<GaitdJointCommands> commands = std::make_unique<GaitdJointCommands>();
};

const GaitdLeg& left_leg() { return atlas().legs[GAITD_LEFT]; }

TEST(FootFeedback, AsksForNothingWhereTheCopIsWhereItShouldBe) {
  FeedbackBench b;
  EXPECT_NEAR(b.torque(left_leg().ankle_pitch, 100), 0.0, 1e-9);
  EXPECT_NEAR(b.torque(left_leg().ankle_roll, 100), 0.0, 1e-9);
}

TEST(FootFeedback, ALegThatCannotRollItsFootPitchesIt) {
  GaitdModel model = atlas();
  for (GaitdLeg& leg : model.legs) leg.ankle_roll = -1;
  FeedbackBench with;
  FeedbackBench without(model);
  for (FeedbackBench* b : {&with, &without}) b->load(GAITD_LEFT, {-0.02, 0.0});
  const int pitch = left_leg().ankle_pitch;
  EXPECT_NE(0.0, with.torque(pitch, 20));
  EXPECT_EQ(with.torque(pitch, 20), without.torque(pitch, 40));
  for (int j = 0; j < model.joint_count; ++j) {
    if (j == pitch || j == model.legs[GAITD_RIGHT].ankle_pitch) continue;
    EXPECT_EQ(0.0, without.commands->joints[j].torque) << model.joints[j].name;
  }
}

TEST(FootFeedback, PushesTheToesDownWhenTheCopIsTooFarBack) {
  FeedbackBench b;
  b.torque(left_leg().ankle_pitch, 1);
  b.load(GAITD_LEFT, {-0.002, 0.0});
  // 2 mm under half of the weight, integrated for 50 ms.
  const double expected = 0.002 * FeedbackBench::half_weight() * kGain * 0.05;
  EXPECT_NEAR(b.torque(left_leg().ankle_pitch, 50), expected, 0.05 * expected);
  EXPECT_NEAR(b.commands->joints[left_leg().ankle_roll].torque, 0.0, 1e-6);
  EXPECT_NEAR(b.commands->joints[atlas().legs[GAITD_RIGHT].ankle_pitch].torque, 0.0, 1e-9);
}

TEST(FootFeedback, IsNoneWithoutGain) {
  FeedbackBench b;
  b.load(GAITD_LEFT, {-0.05, 0.02});
  EXPECT_EQ(b.torque(left_leg().ankle_pitch, 500, 0.0), 0.0);
}

TEST(FootFeedback, KeepsItsLimitAndDoesNotWindUp) {
  FeedbackBench b;
  b.torque(left_leg().ankle_pitch, 1);
  b.load(GAITD_LEFT, {-0.05, 0.0});
  const double most = FootFeedback::kLimit * atlas().joints[left_leg().ankle_pitch].effort_limit;
  EXPECT_NEAR(b.torque(left_leg().ankle_pitch, 2000), most, 1e-6);
  b.load(GAITD_LEFT, {0.05, 0.0});
  EXPECT_LT(b.torque(left_leg().ankle_pitch, 50), 0.0);
}

TEST(FootFeedback, ForgetsWhereTheCopShallBeNearTheEdge) {
  FeedbackBench b;
  b.torque(left_leg().ankle_pitch, 1);
  b.load(GAITD_LEFT, {-0.02, 0.0});
  const double before = b.torque(left_leg().ankle_pitch, 50);
  b.want(GAITD_LEFT, {0.125, 0.0});
  EXPECT_LT(b.torque(left_leg().ankle_pitch, 200), 0.05 * before);
}

TEST(FootFeedback, ForgetsAFootThatStandsOnItsToeOnly) {
  FeedbackBench b;
  b.torque(left_leg().ankle_pitch, 1);
  b.load(GAITD_LEFT, {-0.02, 0.0});
  const double before = b.torque(left_leg().ankle_pitch, 50);
  EXPECT_GT(before, 1.0);
  b.objectives->contact_count = 0;
  b.add_point(GAITD_LEFT, sdk::view(atlas().feet[GAITD_LEFT].toe_point));
  EXPECT_LT(b.torque(left_leg().ankle_pitch, 200), 0.05 * before);
}

}  // namespace
}  // namespace gaitd::plugins
