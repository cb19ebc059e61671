// SPDX-License-Identifier: Apache-2.0
#include "arm_swing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "gaitd/sdk/views.h"
#include "layer_inputs.h"

namespace gaitd::plugins {
namespace {

using testing::atlas;
using walking::JointChain;

// In a swing, with a trunk and legs that turn to the left.
class ArmSwingTest : public ::testing::Test {
 protected:
  ArmSwingTest() {
    gait_ = walk_.gait();
    gait_.phase = GAITD_PHASE_SWING;
    robot_ = walk_.robot;
    robot_.pelvis_twist[2] = 0.3;
  }
  template <class Source>
  GaitdTaskReferences run(Source& source, double seconds) {
    const GaitdTaskSourceInput in{sizeof(in), 0,      testing::layer_time(walk_.dt),
                                  &robot_,    &gait_, &motions_};
    GaitdTaskReferences out;
    for (int i = 0; i < static_cast<int>(seconds / walk_.dt + 0.5); ++i) {
      EXPECT_EQ(source.process(in, out), GAITD_OK);
    }
    return out;
  }
  // Farthest of the arms from their posture (rad).
  static double off(const GaitdTaskReferences& out) {
    double most = 0.0;
    for (int hand = 0; hand < GAITD_MAX_HANDS; ++hand) {
      const JointChain arm = JointChain::arm(atlas(), hand);
      most = std::max(most, (arm.of(out.joint_position) - arm.nominal()).lpNorm<Eigen::Infinity>());
    }
    return most;
  }
  // kg m^2/s that the rates of the references of the arms have about the vertical, and of the rest.
  std::pair<double, double> momenta(const GaitdTaskReferences& out) const {
    dynamics::Dynamics dynamics(atlas());
    dynamics.update(robot_);
    const double rest = dynamics.centroidal_momentum()[2];
    double arms = 0.0;
    for (int j = 0; j < atlas().joint_count; ++j) {
      arms += dynamics.centroidal_momentum_matrix()(2, 6 + j) * out.joint_velocity[j];
    }
    return {arms, rest};
  }

  testing::SyntheticWalk walk_;
  GaitdGaitState gait_;
  GaitdRobotState robot_;
  GaitdMotions motions_{sizeof(GaitdMotions), 0, {}};
  ArmSwing source_{atlas()};
};

TEST_F(ArmSwingTest, TakesItsShareOfTheYawMomentum) {
  const auto [arms, rest] = momenta(run(source_, 0.2));
  EXPECT_GT(rest, 0.5);
  EXPECT_LT(arms, -0.25 * rest);
  EXPECT_GT(arms, -0.6 * rest);
  source_.set_parameter(static_cast<int>(ArmSwing::P::kShare), 0.0);
  source_.reset();
  EXPECT_EQ(off(run(source_, 0.2)), 0.0);
}

TEST_F(ArmSwingTest, BothArmsSwingAgainstEachOther) {
  const GaitdTaskReferences out = run(source_, 0.2);
  const auto forward = [&](int hand) {
    const JointChain arm = JointChain::arm(atlas(), hand);
    return (arm.jacobian(arm.of(out.joint_position)) * arm.of(out.joint_velocity))[3];
  };
  EXPECT_LT(forward(GAITD_LEFT) * forward(GAITD_RIGHT), 0.0);
  EXPECT_GT(forward(GAITD_LEFT), 0.05) << "forward on the left turns the arms to the right";
}

TEST_F(ArmSwingTest, ComesBackToItsPostureAndStaysNearIt) {
  EXPECT_LT(off(run(source_, 20.0)), 0.71);
  gait_.phase = GAITD_PHASE_STAND;
  EXPECT_LT(off(run(source_, 5.0)), 0.01);
}

TEST_F(ArmSwingTest, LeavesAnArmThatSomebodyMovesAlone) {
  GaitdMotion& motion = motions_.parts[GAITD_PART_LEFT_ARM];
  motion.id = 1;
  motion.kind = GAITD_MOTION_ARM;
  motion.axis_mask = 1;
  motion.point_count = 1;
  motion.points[0].time = 0.1;
  const JointChain arm = JointChain::arm(atlas(), GAITD_LEFT);
  motion.points[0].value[0] = arm.nominal()[0] + 0.2;
  const GaitdTaskReferences out = run(source_, 0.5);
  JointChain::Joints expected = arm.nominal();
  expected[0] += 0.2;
  EXPECT_LT((arm.of(out.joint_position) - expected).norm(), 1e-9);
  EXPECT_GT(std::abs(momenta(out).first), 0.05) << "the other one swings";
}

TEST_F(ArmSwingTest, HandsArmsOverWhereTheyAre) {
  const GaitdTaskReferences before = run(source_, 0.2);
  GaitdTaskSourceState state{};
  state.size = sizeof(state);
  source_.get_state(state);
  ArmSwing other(atlas());
  other.set_state(state);
  const GaitdTaskReferences after = run(other, walk_.dt);
  TrajectoryPlayer player(atlas());
  player.set_state(state);
  const GaitdTaskReferences played = run(player, walk_.dt);
  for (int j = 0; j < atlas().joint_count; ++j) {
    EXPECT_NEAR(after.joint_position[j], before.joint_position[j], 2e-3);
    EXPECT_NEAR(played.joint_position[j], before.joint_position[j], 2e-3);
  }
  EXPECT_GT(off(played), 0.01);
  EXPECT_LT(off(run(player, 6.0)), 1e-3) << "it brings them back";
}

}  // namespace
}  // namespace gaitd::plugins
