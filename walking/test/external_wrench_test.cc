// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/external_wrench.h"

#include <gtest/gtest.h>

#include <cmath>

#include "atlas.h"
#include "gaitd/sdk/loads.h"
#include "walking/test/tick.h"

namespace gaitd::walking {
namespace {

using testing::atlas_weight;

using testing::kDt;

using dynamics::Vector6d;
using Eigen::Vector3d;
using testing::atlas;

// Atlas stands still on its left foot, which carries it against `pull` (at the CoM, W).
struct PulledRobot {
  PulledRobot() : robot(testing::standing_state(atlas())) { gait.phase = GAITD_PHASE_STAND; }

  void turn(double yaw) {
    sdk::store(sdk::from_yaw(yaw), robot.pelvis_orientation);
    testing::fill_kinematics(atlas(), 3.0, robot);
  }
  void run_for(double seconds, bool controlled = true) {
    const double weight = atlas().total_mass * atlas().gravity;
    GaitdFootState& foot = robot.feet[GAITD_LEFT];
    const Eigen::Quaterniond sole = sdk::quaternion(foot.orientation);
    const Vector3d heading_offset =
        sdk::from_yaw(sdk::yaw_of(sdk::quaternion(robot.pelvis_orientation))) * offset;
    const Vector3d force = weight * Vector3d::UnitZ() - pull + heading_offset;
    const Vector3d lever = Vector3d(sdk::view(robot.com)) - Vector3d(sdk::view(foot.position));
    const Vector3d moment = lever.cross(force) - couple;
    sdk::view(foot.wrench) << sole.conjugate() * moment, sole.conjugate() * force;
    foot.normal_force = weight;
    for (int i = 0; i < static_cast<int>(seconds / kDt + 0.5); ++i) {
      external.update(kDt, controlled, gait, robot);
    }
  }
  Vector3d force() const { return external.estimate().tail<3>(); }
  Vector3d counted_on() const { return external.steady().tail<3>(); }

  Vector3d pull = Vector3d::Zero();    // N
  Vector3d couple = Vector3d::Zero();  // N m
  Vector3d offset = Vector3d::Zero();  // N, of the force sensors, axes of the heading
  GaitdRobotState robot;
  GaitdGaitState gait{};
  ExternalWrench external{atlas()};
};

TEST(ExternalWrench, ALoadThatNobodyToldOfMakesItHeavier) {
  for (const int phase : {GAITD_PHASE_STAND, GAITD_PHASE_SWING}) {
    PulledRobot b;
    b.run_for(2.0);
    EXPECT_FALSE(b.external.misjudged());
    b.gait.phase = phase;
    b.pull.z() = -0.06 * atlas_weight();
    b.run_for(0.5);
    EXPECT_FALSE(b.external.misjudged()) << "as much as a step does";
    b.run_for(7.5);
    EXPECT_TRUE(b.external.misjudged());
    EXPECT_NEAR(b.external.surplus(), 0.06 * atlas_weight(), 0.002 * atlas_weight());
    b.pull.z() = 0.0;
    b.run_for(8.0);
    EXPECT_FALSE(b.external.misjudged());
  }
}

TEST(ExternalWrench, ALoadThatWasToldOfAndIsNotThereMakesItLighter) {
  PulledRobot b;
  b.run_for(2.0);
  const GaitdLoad load{.body = 0, .reserved = 0, .mass = 35.0, .com = {}};
  ASSERT_TRUE(sdk::put_load(load, b.robot.loads));
  b.gait.phase = GAITD_PHASE_SWING;
  b.run_for(1.0);
  EXPECT_TRUE(b.external.misjudged());
  EXPECT_LT(b.external.surplus(), -0.05 * atlas_weight());
  b.robot.loads = {};
  b.run_for(0.1);
  EXPECT_FALSE(b.external.misjudged()) << "told that it was not there";
}

TEST(ExternalWrench, ASteadyPullIsFoundAndCountedOn) {
  PulledRobot b;
  b.run_for(2.0);
  EXPECT_TRUE(b.external.tared());
  EXPECT_FALSE(b.external.pulled());
  b.pull = 0.08 * atlas_weight() * Vector3d(0.6, -0.8, 0.0);
  b.couple = Vector3d(10.0, 5.0, -2.0);
  b.run_for(0.5);
  EXPECT_LT((b.force() - b.pull).norm(), 0.1 * b.pull.norm());
  b.run_for(1.0);
  EXPECT_TRUE(b.external.pulled());
  EXPECT_LT((b.counted_on() - b.pull).norm(), 0.02 * b.pull.norm());
  EXPECT_LT((b.external.steady().head<3>() - b.couple).norm(), 0.5);
}

TEST(ExternalWrench, APullThatEndsIsSoonForgotten) {
  PulledRobot b;
  b.run_for(2.0);
  b.pull = Vector3d(0.0, 0.1 * atlas_weight(), 0.0);
  b.run_for(3.0);
  ASSERT_TRUE(b.external.pulled());
  b.pull.setZero();
  b.run_for(0.15);
  EXPECT_LT(b.counted_on().norm(), 0.02 * atlas_weight());
  b.run_for(2.0);
  EXPECT_FALSE(b.external.pulled());
  EXPECT_LT(b.force().norm(), 1.0);
}

// The largest that the robot has to hold standing, and one that it has to step for.
TEST(ExternalWrench, APushIsNotCountedOn) {
  for (const auto& [force, time] : {std::pair(340.0, 0.2), std::pair(1500.0, 0.1)}) {
    PulledRobot b;
    b.run_for(2.0);
    double most = 0.0;
    const auto run = [&](double seconds) {
      for (int i = 0; i < static_cast<int>(seconds / kDt); ++i) {
        b.run_for(kDt);
        most = std::max(most, b.counted_on().norm());
      }
    };
    b.pull = Vector3d(force, 0.0, 0.0);
    run(time);
    b.pull.setZero();
    run(1.0);
    EXPECT_LT(most, 0.03 * atlas_weight()) << force;
    EXPECT_FALSE(b.external.pulled()) << force;
  }
}

TEST(ExternalWrench, ADraughtIsLeftToTheFeedback) {
  PulledRobot b;
  b.run_for(2.0);
  b.pull = Vector3d(0.025 * atlas_weight(), 0.0, 0.0);
  b.run_for(3.0);
  EXPECT_NEAR(b.force().x(), b.pull.x(), 1.0);
  EXPECT_FALSE(b.external.pulled());
}

// Drives that stick and bend: forces that come and go with the steps.
TEST(ExternalWrench, WhatComesAndGoesIsNoPull) {
  PulledRobot b;
  b.run_for(2.0);
  bool pulled = false;
  double largest = 0.0;
  for (double time = 0.0; time < 16.0; time += 0.01) {
    const double amplitude = 0.07 * atlas_weight() * std::min(1.0, time / 12.0);
    b.pull = Vector3d(0.0, amplitude * std::sin(2.0 * M_PI * 1.2 * time), 0.0);
    b.run_for(0.01);
    pulled |= b.external.pulled();
    largest = std::max(largest, b.force().norm());
  }
  EXPECT_FALSE(pulled);
  EXPECT_GT(largest, 0.04 * atlas_weight());
  b.pull = Vector3d(0.12 * atlas_weight(), 0.0, 0.0);
  b.run_for(1.0);
  EXPECT_TRUE(b.external.pulled());
}

TEST(ExternalWrench, AWindThatRisesIsAPull) {
  PulledRobot b;
  b.run_for(2.0);
  for (double time = 0.0; time < 5.0; time += 0.01) {
    b.pull = Vector3d(0.016 * atlas_weight() * time, 0.0, 0.0);
    b.run_for(0.01);
  }
  EXPECT_TRUE(b.external.pulled());
}

TEST(ExternalWrench, ALoadIsShownAndNotCountedOn) {
  PulledRobot b;
  b.run_for(2.0);
  b.pull = Vector3d(0.08 * atlas_weight(), 0.0, -0.06 * atlas_weight());
  b.run_for(2.0);
  EXPECT_NEAR(b.force().z(), b.pull.z(), 2.0);
  EXPECT_EQ(b.counted_on().z(), 0.0);
  EXPECT_NEAR(b.counted_on().x(), b.pull.x(), 2.0);
}

TEST(ExternalWrench, WhatShowsWhenNobodyPullsTurnsWithTheRobot) {
  PulledRobot b;
  b.offset = Vector3d(60.0, -30.0, 20.0);
  b.run_for(2.0);
  EXPECT_LT(b.force().norm(), 1.0);
  b.turn(2.0);
  b.pull = Vector3d(0.0, 140.0, 0.0);
  b.run_for(2.0);
  EXPECT_LT((b.force() - b.pull).norm(), 2.0);
}

// The sensors of a light robot: their offsets turn with the feet.
TEST(ExternalWrench, APullBelowTheOffsetsOfTheSensorsIsNotBelieved) {
  PulledRobot b;
  b.offset = Vector3d(0.0, 0.12 * atlas_weight(), 0.0);
  b.run_for(2.0);
  b.pull = Vector3d(0.1 * atlas_weight(), 0.0, 0.0);
  b.run_for(3.0);
  EXPECT_FALSE(b.external.pulled());
  b.pull = Vector3d(0.15 * atlas_weight(), 0.0, 0.0);
  b.run_for(3.0);
  EXPECT_TRUE(b.external.pulled());
}

TEST(ExternalWrench, FeetWithoutSensorsShowNothing) {
  GaitdModel model = atlas();
  for (GaitdFoot& foot : model.feet) foot.force_sensor.body = -1;
  PulledRobot b;
  ExternalWrench blind(model);
  for (int i = 0; i < 3000; ++i) blind.update(kDt, true, b.gait, b.robot);
  EXPECT_FALSE(blind.tared());
}

TEST(ExternalWrench, WithoutATareNothingIsBelieved) {
  PulledRobot b;
  b.gait.phase = GAITD_PHASE_SWING;
  b.pull = Vector3d(150.0, 0.0, 0.0);
  b.run_for(3.0);
  EXPECT_FALSE(b.external.tared());
  EXPECT_EQ(b.external.estimate(), Vector6d::Zero().eval());
  b.gait.phase = GAITD_PHASE_STAND;
  b.run_for(3.0, false);  // not under control
  EXPECT_FALSE(b.external.tared());
}

TEST(ExternalWrench, ATareThatIsAskedForReplacesTheFirst) {
  PulledRobot b;
  b.pull = Vector3d(150.0, 0.0, 0.0);
  b.run_for(2.0);  // somebody held it when it stood up
  EXPECT_LT(b.force().norm(), 1.0);
  b.pull.setZero();
  b.run_for(1.0);
  EXPECT_NEAR(b.force().x(), -150.0, 2.0);
  b.external.tare();
  b.run_for(2.0);
  EXPECT_LT(b.force().norm(), 1.0);
  EXPECT_FALSE(b.external.pulled());
}

// The balance of moments about the CoM, solved for the acceleration by hand.
TEST(Lean, IsWhatTheWrenchDoesToTheCentreOfMass) {
  const double mass = 100.0, gravity = 9.8, omega = 3.5, height = gravity / (omega * omega);
  Vector6d wrench;
  wrench << 12.0, -7.0, 3.0, 80.0, -40.0, 0.0;
  const Vector3d com(0.1, 0.2, height), cmp(0.13, 0.15, 0.0);
  // Contact force through the CMP, with a moment about the CoM that cancels that of the wrench.
  const double load = mass * gravity;
  const Vector3d arm = cmp - com;
  const double f_x = (-load * arm.x() + wrench[1]) / height;
  const double f_y = (-load * arm.y() - wrench[0]) / height;
  const Vector3d moment = arm.cross(Vector3d(f_x, f_y, load)) + wrench.head<3>();
  ASSERT_LT(moment.head<2>().norm(), 1e-9);
  const Eigen::Vector2d acceleration = (Eigen::Vector2d(f_x, f_y) + wrench.segment<2>(3)) / mass;
  const Eigen::Vector2d leaning = lean(wrench, mass, gravity, omega);
  EXPECT_LT((acceleration - omega * omega * (com + leaning.homogeneous() - cmp).head<2>()).norm(),
            1e-9);
}

}  // namespace
}  // namespace gaitd::walking
