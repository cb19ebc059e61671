// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/swing_trajectory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "gaitd/sdk/views.h"

namespace gaitd::walking {
namespace {

using Eigen::Vector3d;

constexpr SwingShape kShape;

GaitdPose pose_at(double x, double y, double z, double roll = 0, double pitch = 0, double yaw = 0) {
  GaitdPose p{};
  p.position[0] = x;
  p.position[1] = y;
  p.position[2] = z;
  sdk::store(sdk::from_roll_pitch_yaw(roll, pitch, yaw), p.orientation);
  return p;
}

GaitdFootstep landing(const GaitdPose& at, double swing_height = 0.1) {
  GaitdFootstep step{};
  step.pose = at;
  step.swing_height = swing_height;
  return step;
}

constexpr double kSwingDuration = 0.6;

SwingTrajectory swing_between(const GaitdPose& from, const GaitdFootstep& to) {
  SwingTrajectory s;
  s.begin(from, sdk::Vector6d::Zero(), from.position[2], to, kSwingDuration, kShape);
  return s;
}

TEST(SwingTrajectory, LeavesAtRestAndMeetsTheFootholdGoingDown) {
  const GaitdPose from = pose_at(0.1, 0.2, 0.05, 0.0, 0.1, 0.2);
  const GaitdPose to = pose_at(0.7, 0.15, 0.0, 0.05, -0.1, 0.4);
  const SwingTrajectory s = swing_between(from, landing(to));
  const auto begin = s.evaluate(0.0);
  EXPECT_LT((begin.position - Vector3d(sdk::view(from.position))).norm(), 1e-12);
  EXPECT_LT(begin.velocity.norm(), 1e-12);
  EXPECT_LT(begin.acceleration.norm(), 1e-9);
  EXPECT_LT(begin.angular_velocity.norm(), 1e-12);
  EXPECT_LT(begin.orientation.angularDistance(sdk::quaternion(from.orientation)), 1e-7);
  const auto end = s.evaluate(kSwingDuration);
  const double down = kShape.landing_speed;
  EXPECT_LT((end.position - Vector3d(sdk::view(to.position))).norm(), 1e-9);
  EXPECT_LT((end.velocity - Vector3d(0, 0, -down)).norm(), 1e-9);
  EXPECT_LT(end.acceleration.norm(), 1e-6);
  EXPECT_LT(end.angular_velocity.norm(), 1e-9);
  EXPECT_LT(end.orientation.angularDistance(sdk::quaternion(to.orientation)), 1e-7);
}

// Largest differences over one tick that the derivatives do not explain.
struct Jumps {
  double position = 0.0;      // m
  double velocity = 0.0;      // m/s
  double acceleration = 0.0;  // m/s^2
  double orientation = 0.0;   // rad
};

void compare(const SwingTrajectory::Sample& a, const SwingTrajectory::Sample& b, double dt,
             Jumps& worst) {
  worst.position = std::max(
      worst.position, (b.position - a.position - 0.5 * dt * (a.velocity + b.velocity)).norm());
  worst.velocity =
      std::max(worst.velocity,
               (b.velocity - a.velocity - 0.5 * dt * (a.acceleration + b.acceleration)).norm());
  worst.acceleration = std::max(worst.acceleration, (b.acceleration - a.acceleration).norm());
  const Vector3d turned = sdk::log_so3(b.orientation * a.orientation.conjugate());
  worst.orientation = std::max(
      worst.orientation, (turned - 0.5 * dt * (a.angular_velocity + b.angular_velocity)).norm());
}

Jumps jumps(const SwingTrajectory& s, double from, double to) {
  constexpr double kStep = 1e-4;
  Jumps worst;
  for (double t = from; t + kStep < to; t += kStep) {
    compare(s.evaluate(t), s.evaluate(t + kStep), kStep, worst);
  }
  return worst;
}

void expect_smooth(const Jumps& j, const std::string& what) {
  EXPECT_LT(j.position, 1e-8) << what;
  EXPECT_LT(j.velocity, 1e-5) << what;
  EXPECT_LT(j.acceleration, 0.2) << what;  // m/s^2 in 0.1 ms: a jerk, no jump
  EXPECT_LT(j.orientation, 1e-7) << what;
}

TEST(SwingTrajectory, IsContinuousInAccelerationOverTheApex) {
  for (double rise : {-0.2, 0.0, 0.2}) {
    for (double height : {0.05, 0.1, 0.25}) {
      const SwingTrajectory s = swing_between(
          pose_at(0, 0.1, 0), landing(pose_at(0.6, 0.12, rise, 0.1, 0.05, 0.3), height));
      expect_smooth(jumps(s, 0.0, kSwingDuration), std::to_string(rise));
    }
  }
}

TEST(SwingTrajectory, VelocityAndAccelerationAreTheDerivatives) {
  const SwingTrajectory s =
      swing_between(pose_at(0, 0.1, 0), landing(pose_at(0.6, 0.12, 0.1, 0, 0, 0.3)));
  constexpr double kStep = 1e-5;
  for (double t = 0.01; t < kSwingDuration - 0.01; t += 0.013) {
    const auto a = s.evaluate(t - kStep);
    const auto b = s.evaluate(t);
    const auto c = s.evaluate(t + kStep);
    EXPECT_LT(((c.position - a.position) / (2 * kStep) - b.velocity).norm(), 1e-6);
    EXPECT_LT(((c.velocity - a.velocity) / (2 * kStep) - b.acceleration).norm(), 2e-3);
    const Vector3d turned = sdk::log_so3(c.orientation * a.orientation.conjugate());
    EXPECT_LT((turned / (2 * kStep) - b.angular_velocity).norm(), 1e-6);
    EXPECT_LT(
        ((c.angular_velocity - a.angular_velocity) / (2 * kStep) - b.angular_acceleration).norm(),
        2e-3);
  }
}

TEST(SwingTrajectory, ClearsTheHigherFootholdByTheSwingHeight) {
  for (double rise : {-0.3, -0.1, 0.0, 0.1, 0.3}) {
    for (double height : {0.05, 0.15}) {
      const SwingTrajectory s =
          swing_between(pose_at(0, 0, 0), landing(pose_at(0.5, 0, rise), height));
      double highest = -1.0;
      for (double t = 0.0; t <= kSwingDuration; t += 1e-3) {
        highest = std::max(highest, s.evaluate(t).position.z());
      }
      EXPECT_NEAR(highest, std::max(0.0, rise) + height, 2e-3) << rise;
    }
  }
}

TEST(SwingTrajectory, StaysAboveTheGroundOnTheWay) {
  const SwingTrajectory s = swing_between(pose_at(0, 0, 0), landing(pose_at(0.7, 0, 0)));
  for (double t = 0.0; t <= kSwingDuration; t += 1e-3) {
    EXPECT_GT(s.evaluate(t).position.z(), -1e-9) << t;
  }
}

// Down an edge the foot is above its foothold well before the end. A foothold that moves after that
// is reached in what is left, not at once.
TEST(SwingTrajectory, AFootholdThatMovesAfterTheArrivalIsNoJolt) {
  SwingTrajectory s = swing_between(pose_at(0, 0.1, 0), landing(pose_at(0.3, 0.1, -0.2)));
  const double moved = 0.9 * kSwingDuration;
  s.replan(moved, landing(pose_at(0.32, 0.1, -0.2)), kSwingDuration, kShape);
  double hardest = 0.0;
  for (double t = moved; t <= kSwingDuration; t += 1e-4) {
    hardest = std::max(hardest, s.evaluate(t).acceleration.head<2>().norm());
  }
  const double way = 0.02 + 0.04 * 0.3;  // moved, and what it went beyond
  EXPECT_LT(hardest, 5.8 * way / std::pow(kSwingDuration - moved, 2));
  EXPECT_NEAR(s.evaluate(kSwingDuration).position.x(), 0.32, 1e-9);
}

TEST(SwingTrajectory, KeepsGoingDownWhenTheGroundIsLate) {
  const SwingTrajectory s = swing_between(pose_at(0, 0, 0), landing(pose_at(0.5, 0.1, 0)));
  const double late = kShape.landing_speed;
  ASSERT_GT(late, 0.0);
  for (double t : {0.05, 0.1, 0.5}) {
    const auto sample = s.evaluate(kSwingDuration + t);
    EXPECT_LE(sample.position.z(), -late * t);
    EXPECT_NEAR(sample.position.x(), 0.5, 1e-9);
    EXPECT_NEAR(sample.position.y(), 0.1, 1e-9);
    EXPECT_LE(sample.velocity.z(), -late);
    EXPECT_LT(sample.velocity.head<2>().norm(), 1e-9);
    EXPECT_LT(sample.acceleration.norm(), 1e-12);
  }
  const Vector3d before = s.evaluate(kSwingDuration - 1e-6).position;
  EXPECT_LT((s.evaluate(kSwingDuration + 1e-6).position - before).norm(), 1e-5);
}

TEST(SwingTrajectory, AMovedFootholdIsReachedWithoutAJump) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-0.1, 0.1);
  for (int run = 0; run < 100; ++run) {
    SwingTrajectory s = swing_between(pose_at(0, 0.1, 0), landing(pose_at(0.5, 0.1, 0)));
    Jumps worst;
    double t = 0.0;
    GaitdPose goal = pose_at(0.5, 0.1, 0);
    for (int replan = 0; replan < 3; ++replan) {
      const double until = t + 0.1 + uniform(random);
      worst = jumps(s, t, until);
      t = until;
      const auto before = s.evaluate(t);
      goal = pose_at(0.5 + uniform(random), 0.1 + uniform(random), 0);
      s.replan(t, landing(goal), kSwingDuration, kShape);
      const auto after = s.evaluate(t);
      EXPECT_LT((after.position - before.position).norm(), 1e-9) << t;
      EXPECT_LT((after.velocity - before.velocity).norm(), 1e-8) << t;
      EXPECT_LT((after.acceleration - before.acceleration).norm(), 1e-6) << t;
      EXPECT_LT(after.orientation.angularDistance(before.orientation), 1e-7);
    }
    EXPECT_LT(worst.position, 1e-7);
    EXPECT_LT((s.evaluate(kSwingDuration).position - Vector3d(sdk::view(goal.position))).norm(),
              1e-9);
  }
}

TEST(SwingTrajectory, ReplanningForTheSameGoalAtEveryTickHardlyChangesThePath) {
  const GaitdFootstep to = landing(pose_at(0.5, 0.15, 0.05));
  const SwingTrajectory once = swing_between(pose_at(0, 0.1, 0), to);
  SwingTrajectory often = once;
  for (double t = 0.0; t < kSwingDuration; t += 0.001) {
    often.replan(t, to, kSwingDuration, kShape);
    const auto a = once.evaluate(t);
    const auto b = often.evaluate(t);
    ASSERT_LT((a.position - b.position).head<2>().norm(), 1e-6) << t;
    ASSERT_LT(std::abs(a.position.z() - b.position.z()), 0.01) << t;
  }
  EXPECT_LT(
      (often.evaluate(kSwingDuration).position - once.evaluate(kSwingDuration).position).norm(),
      1e-9);
}

TEST(SwingTrajectory, ARotationGoesOnAtItsRateWhenReplanned) {
  const GaitdFootstep to = landing(pose_at(0.5, 0.15, 0, 0, 0, 0.6));
  SwingTrajectory s = swing_between(pose_at(0, 0.1, 0), to);
  const auto before = s.evaluate(0.3);
  s.replan(0.3, to, kSwingDuration, kShape);
  const auto after = s.evaluate(0.3);
  ASSERT_GT(before.angular_velocity.norm(), 0.5);
  EXPECT_LT((after.angular_velocity - before.angular_velocity).norm(), 1e-9);
  EXPECT_LT(after.orientation.angularDistance(before.orientation), 1e-7);
}

TEST(SwingTrajectory, ALongerSwingArrivesLater) {
  SwingTrajectory s = swing_between(pose_at(0, 0.1, 0), landing(pose_at(0.5, 0.1, 0)));
  s.replan(0.2, landing(pose_at(0.5, 0.1, 0)), 0.8, kShape);
  EXPECT_LT((s.evaluate(0.8).position - Vector3d(0.5, 0.1, 0)).norm(), 1e-9);
  EXPECT_GT(s.evaluate(0.6).position.z(), 0.01);
}

TEST(SwingTrajectory, TheLastMomentsAreNeverReplanned) {
  SwingTrajectory s = swing_between(pose_at(0, 0.1, 0), landing(pose_at(0.5, 0.1, 0)));
  const auto before = s.evaluate(kSwingDuration - 1e-3);
  s.replan(kSwingDuration - 1e-3, landing(pose_at(0.9, 0.3, 0)), kSwingDuration, kShape);
  EXPECT_LT((s.evaluate(kSwingDuration - 1e-3).position - before.position).norm(), 1e-12);
  EXPECT_LT((s.evaluate(kSwingDuration).position - Vector3d(0.5, 0.1, 0)).norm(), 1e-9);
}

TEST(Quintic, MeetsPositionVelocityAndAccelerationAtBothEnds) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> uniform(-2, 2);
  for (int run = 0; run < 200; ++run) {
    double v[6];
    for (double& x : v) x = uniform(random);
    const double duration = 0.3 + std::abs(uniform(random));
    Quintic q;
    q.fit(v[0], v[1], v[2], v[3], v[4], v[5], duration);
    EXPECT_NEAR(q.position(0), v[0], 1e-12);
    EXPECT_NEAR(q.velocity(0), v[1], 1e-12);
    EXPECT_NEAR(q.acceleration(0), v[2], 1e-12);
    EXPECT_NEAR(q.position(duration), v[3], 1e-9);
    EXPECT_NEAR(q.velocity(duration), v[4], 1e-9);
    EXPECT_NEAR(q.acceleration(duration), v[5], 1e-8);
  }
}

TEST(SwingTrajectory, RisesInFrontOfAnEdgeAndIsLevelAboveIt) {
  const GaitdPose from = pose_at(0.0, 0.0, 0.06, 0.0, 0.35, 0.0);  // rolled over the toe
  const GaitdPose to = pose_at(0.3, 0.0, 0.2);
  SwingTrajectory s;
  s.begin(from, sdk::Vector6d::Zero(), 0.0, landing(to), kSwingDuration, kShape);
  for (double t = 0.0; t <= kSwingDuration; t += 0.005) {
    const auto sample = s.evaluate(t);
    // The front half of the foot is 0.13 m long, the edge 0.16 m ahead of where the foot stood.
    const Vector3d toe = sample.position + sample.orientation * Vector3d(0.13, 0.0, 0.0);
    if (toe.x() > 0.155) EXPECT_GT(toe.z(), 0.2) << t;
    EXPECT_LT(sample.position.z(), 0.2 + 0.1 + 1e-9) << t;
  }
}

// A foot that rolled over its toe is turned back as it rises: its origin has to give way. The riser
// may be a centimetre or two nearer than odometry believes.
TEST(SwingTrajectory, TheToeDrawsBackUntilItIsAboveTheEdge) {
  SwingShape shape = kShape;
  shape.toe = 0.13;
  const Vector3d ahead(shape.toe, 0.0, 0.0);
  const GaitdPose from = pose_at(0.03, 0.0, 0.1, 0.0, 0.8, 0.0);
  const GaitdPose to = pose_at(0.3, 0.05, 0.2, 0.0, -0.1, 0.2);
  SwingTrajectory s;
  s.begin(from, sdk::Vector6d::Zero(), 0.0, landing(to), kSwingDuration, shape);
  const auto toe = [&](double t) -> Vector3d {
    return s.evaluate(t).position + s.evaluate(t).orientation * ahead;
  };
  const Vector3d before = toe(0.0);
  const double way = toe(kSwingDuration).x() - before.x();
  double back = 0.0;
  for (double t = 0.0; t <= kSwingDuration; t += 0.005) {
    back = std::max(back, before.x() - toe(t).x());
    if (toe(t).z() < 0.1) EXPECT_LT(toe(t).x(), before.x() + 1e-9) << t;
    if (toe(t).z() > 0.05 && toe(t).z() < 0.1) EXPECT_LT(toe(t).x(), before.x() - 0.03 * way) << t;
  }
  EXPECT_NEAR(back, 0.06 * way, 1e-3);
  EXPECT_LT((s.evaluate(kSwingDuration).position - Vector3d(0.3, 0.05, 0.2)).norm(), 1e-9);
  for (double t = 0.02; t < kSwingDuration - 0.02; t += 0.01) {
    const double h = 1e-5;
    const Vector3d rate = (s.evaluate(t + h).position - s.evaluate(t - h).position) / (2.0 * h);
    EXPECT_LT((rate - s.evaluate(t).velocity).norm(), 0.02) << t;
  }
}

TEST(SwingTrajectory, IsPastAnEdgeBeforeItComesDown) {
  const GaitdPose from = pose_at(0.0, 0.0, 0.2);
  const GaitdPose to = pose_at(0.38, 0.0, 0.0);
  const SwingTrajectory s = swing_between(from, landing(to));
  for (double t = 0.0; t <= kSwingDuration; t += 0.005) {
    const Vector3d heel = s.evaluate(t).position - Vector3d(0.13, 0.0, 0.0);
    if (heel.z() < 0.2) EXPECT_TRUE(heel.x() > 0.19 || heel.x() < 0.001) << t;
  }
}

// Footholds near an edge: where odometry is wrong by a centimetre the heel must not be caught on
// it.
TEST(SwingTrajectory, ComesDownAnEdgeBeyondItsFootholdAndGoesBack) {
  const SwingTrajectory s = swing_between(pose_at(0.0, 0.0, 0.2), landing(pose_at(0.5, 0.1, 0.0)));
  for (double t = 0.5 * kSwingDuration; t <= kSwingDuration; t += 0.005) {
    const Vector3d at = s.evaluate(t).position;
    if (at.z() > 0.08 && at.z() < 0.2) EXPECT_GT(at.x(), 0.51) << t;
  }
  EXPECT_LT((s.evaluate(kSwingDuration).position - Vector3d(0.5, 0.1, 0.0)).norm(), 1e-9);
  EXPECT_LT(s.evaluate(kSwingDuration).velocity.head<2>().norm(), 1e-9);
}

TEST(SwingTrajectory, GoesOnFromTheTwistOfTheFoot) {
  sdk::Vector6d twist;
  twist << 0.1, 1.5, -0.2, 0.3, 0.0, 0.4;
  SwingTrajectory s;
  s.begin(pose_at(0.0, 0.0, 0.05, 0.0, 0.3, 0.0), twist, 0.0, landing(pose_at(0.4, 0.0, 0.0)),
          kSwingDuration, kShape);
  const auto begin = s.evaluate(0.0);
  EXPECT_LT((begin.velocity - twist.tail<3>()).norm(), 1e-12);
  EXPECT_LT((begin.angular_velocity - twist.head<3>()).norm(), 1e-12);
}

TEST(SwingTrajectory, AnOverdueTouchdownIsSoughtFasterAndFaster) {
  const SwingTrajectory s = swing_between(pose_at(0, 0, 0), landing(pose_at(0.3, 0, 0)));
  double last = -kShape.landing_speed + 1e-9;
  for (double late = 0.005; late < 0.05; late += 0.005) {
    const double now = s.evaluate(kSwingDuration + late).velocity.z();
    EXPECT_LT(now, last);
    last = now;
  }
  // Position, speed and the onset belong together: before, in and after the acceleration.
  const double dt = 1e-6;
  for (double late : {0.02, 0.05, 0.2}) {
    const double before = s.evaluate(kSwingDuration + late - dt).position.z();
    const double after = s.evaluate(kSwingDuration + late + dt).position.z();
    EXPECT_NEAR((after - before) / (2 * dt), s.evaluate(kSwingDuration + late).velocity.z(), 1e-6);
  }
  EXPECT_GT(s.evaluate(kSwingDuration + 10.0).velocity.z(), -1.5);  // not without end
}

TEST(SwingTrajectory, AnOverdueTouchdownIsSoughtNoFasterThanItMayBe) {
  const SwingTrajectory s = swing_between(pose_at(0, 0, 0), landing(pose_at(0.3, 0, 0)));
  double fastest = 0.0;
  for (double late = 0.0; late < 1.0; late += 0.01) {
    fastest = std::max(fastest, -s.evaluate(kSwingDuration + late).velocity.z());
  }
  EXPECT_NEAR(fastest, kShape.late_speed, 1e-9);
}

}  // namespace
}  // namespace gaitd::walking
