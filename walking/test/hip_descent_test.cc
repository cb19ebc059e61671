// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/hip_descent.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gaitd::walking {
namespace {

constexpr double kDuration = 0.8;  // s

// A foot that comes down 0.3 m ahead of the CoM, `below` the foot that stands (m).
class HipDescent : public ::testing::Test {
 protected:
  void step(double below) {
    GaitdPose from{};
    from.orientation[3] = 1.0;
    from.position[0] = -0.3;
    GaitdFootstep to{};
    to.pose.orientation[3] = 1.0;
    to.pose.position[0] = 0.3;
    to.pose.position[2] = -below;
    to.swing_height = 0.1;
    swing.begin(from, sdk::Vector6d::Zero(), 0.0, to, kDuration, {});
  }
  double at(double t) const { return highest_hip(swing, t, kDuration, leg); }
  // m: of the leg at touchdown with its hip at that height.
  double length(double height, double t) const {
    const SwingTrajectory::Sample foot = swing.evaluate(t);
    return std::hypot(height - foot.position.z() - leg.ankle_in_sole.z(),
                      foot.position.x() - leg.hip.x());
  }
  SwingTrajectory swing;
  // Over the foot that stands, and still: the pendulum stays where it is.
  SwingLeg leg{.hip = Eigen::Vector3d(0.0, 0.1, 0.9),
               .ankle_in_sole = Eigen::Vector3d(0.0, 0.1, 0.08),
               .longest = 0.8,
               .longest_down = 0.8,
               .ground = 0.0,
               .lever = Eigen::Vector2d::Zero(),
               .velocity = Eigen::Vector2d::Zero(),
               .omega = 3.0,
               .gravity = 9.81};
};

TEST_F(HipDescent, AtTouchdownTheLegIsAsLongAsItMayBe) {
  for (double below : {-0.1, 0.0, 0.1, 0.2}) {
    step(below);
    EXPECT_NEAR(length(at(kDuration - 1e-6), kDuration), leg.longest, 1e-4) << below;
  }
}

TEST_F(HipDescent, ComesDownGentlyAndInTime) {
  step(0.2);
  double last = at(0.5 * kDuration);
  for (double t = 0.5 * kDuration; t < kDuration; t += 0.01) {
    const double height = at(t);
    EXPECT_LE(height, last + 1e-9) << t;
    // As fast as a fifth of g stops it in time.
    const double left = std::max(0.0, kDuration - t - 0.4 / leg.omega) + 0.01;
    EXPECT_GE(height, last - 0.01 * 0.2 * leg.gravity * left - 1e-4) << t;
    // A leg that is 0.4 / omega behind is never too high.
    const double later = std::min(t + 0.4 / leg.omega, kDuration);
    EXPECT_LE(length(height, later), leg.longest + 0.02) << t;
    last = height;
  }
}

TEST_F(HipDescent, FollowsAFootThatFindsNoGround) {
  step(0.0);
  const double due = at(kDuration - 1e-6);
  const double late = at(kDuration + 0.1);
  EXPECT_LT(late, due - 0.02);
  EXPECT_LT(at(kDuration + 0.2), late - 0.02);
}

TEST_F(HipDescent, AHipThatGoesOnMayStayHigher) {
  step(0.1);
  const double still = at(0.7 * kDuration);
  leg.velocity = Eigen::Vector2d(0.5, 0.0);
  EXPECT_GT(at(0.7 * kDuration), still + 0.01);
}

TEST_F(HipDescent, FootholdsOutOfReachGiveNumbers) {
  step(3.0);
  EXPECT_TRUE(std::isfinite(at(kDuration)));
}

// A leg on a foot 0.2 m to the side of its hip.
TrailingLeg trailing() {
  return {.hip = Eigen::Vector3d(0.0, 0.2, 0.85),
          .ankle = Eigen::Vector3d(0.0, 0.0, 0.08),
          .heading = Eigen::Vector2d::UnitX(),
          .flat = 0.15,
          .longest = 0.8,
          .lever = Eigen::Vector2d::Zero(),
          .velocity = Eigen::Vector2d::Zero(),
          .swing = 0.0,
          .transfer = 0.2,
          .omega = 3.0,
          .gravity = 9.81};
}

TEST(TrailingLeg, IsAsLongAsItMayBeWhereTheHipIsAtLiftOff) {
  TrailingLeg leg = trailing();
  EXPECT_NEAR(highest_hip(leg), 0.08 + std::sqrt(0.8 * 0.8 - 0.2 * 0.2), 1e-9);
  leg.velocity = Eigen::Vector2d(0.0, 0.5);
  EXPECT_NEAR(highest_hip(leg), 0.08 + std::sqrt(0.8 * 0.8 - 0.3 * 0.3), 1e-9);
  // A transfer that waits, as far ahead as the leg is behind.
  leg.transfer = 0.0;
  const double away = 0.2 + 0.5 * 0.4 / leg.omega;
  EXPECT_NEAR(highest_hip(leg), 0.08 + std::sqrt(0.8 * 0.8 - away * away), 1e-9);
}

TEST(TrailingLeg, AHeelThatComesUpMakesUpForWhatIsAheadAndNotForWhatIsAside) {
  TrailingLeg leg = trailing();
  leg.hip.x() = 0.15;
  const double flat = highest_hip(leg);
  EXPECT_NEAR(flat, 0.08 + std::sqrt(0.8 * 0.8 - 0.2 * 0.2 - 0.15 * 0.15), 1e-9);
  leg.hip.x() = 0.4;
  EXPECT_NEAR(highest_hip(leg), flat, 1e-9);
  leg.hip.x() = -0.4;
  EXPECT_LT(highest_hip(leg), flat - 0.05);
  leg.hip = Eigen::Vector3d(0.15, 0.4, 0.85);
  EXPECT_LT(highest_hip(leg), flat - 0.05);
}

TEST(TrailingLeg, TheHipComesDownGentlyAndIsDownAtTouchdown) {
  TrailingLeg leg = trailing();
  const double down = highest_hip(leg);
  double last = down;
  for (double left = 0.01; left < 0.5; left += 0.01) {
    leg.swing = left;
    const double height = highest_hip(leg);
    const double early = std::max(left - 0.4 / leg.omega, 0.0);
    EXPECT_NEAR(height, down + 0.5 * 0.2 * leg.gravity * early * early, 1e-9) << left;
    EXPECT_GE(height, last - 1e-9) << left;
    last = height;
  }
}

TEST(TrailingLeg, APendulumThatFallsAwayFromItsFootAsksForALowerHip) {
  TrailingLeg leg = trailing();
  leg.swing = 0.1;
  const double still = highest_hip(leg);
  leg.lever = Eigen::Vector2d(0.0, 0.1);
  EXPECT_LT(highest_hip(leg), still - 0.005);
  leg.swing = 3.0;
  EXPECT_TRUE(std::isfinite(highest_hip(leg)));
}

}  // namespace
}  // namespace gaitd::walking
