// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/minimum_jerk_path.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/pose_path.h"

namespace gaitd::walking {
namespace {

using Axes = MinimumJerkPath::Axes;

constexpr std::array<double, 3> kTimes = {0.7, 1.9, 2.6};

MinimumJerkPath path_through(const std::array<double, 3>& values,
                             const MinimumJerkPath::Sample& start = {}) {
  std::array<Axes, 3> points;
  for (int i = 0; i < 3; ++i) points[i] = Axes::Constant(values[i]);
  MinimumJerkPath path;
  path.begin(start, kTimes.data(), points.data(), 3);
  return path;
}

TEST(MinimumJerkPath, OneMotionIsTheQuinticOfFlashAndHogan) {
  MinimumJerkPath path;
  const double time = 2.0;
  const Axes goal = Axes::Constant(0.3);
  path.begin({}, &time, &goal, 1);
  for (const double s : {0.1, 0.5, 0.8}) {
    EXPECT_NEAR(path.at(s * time).value[0],
                0.3 * (10 * std::pow(s, 3) - 15 * std::pow(s, 4) + 6 * std::pow(s, 5)), 1e-12);
  }
  EXPECT_NEAR(path.at(1.0).velocity[4], 0.3 / time * 1.875, 1e-12);
}

TEST(MinimumJerkPath, GoesThroughItsPointsAndRestsAtTheLast) {
  const MinimumJerkPath path = path_through({0.4, -0.1, 0.2});
  EXPECT_NEAR(path.at(0.7).value[3], 0.4, 1e-12);
  EXPECT_NEAR(path.at(1.9).value[3], -0.1, 1e-12);
  EXPECT_NEAR(path.at(9.0).value[3], 0.2, 1e-12);
  EXPECT_EQ(path.at(9.0).velocity[3], 0.0);
  EXPECT_EQ(path.at(9.0).acceleration[3], 0.0);
}

TEST(MinimumJerkPath, SnapIsContinuousAtThePoints) {
  const MinimumJerkPath path = path_through({0.4, -0.1, 0.2});
  constexpr double h = 1e-3;
  const auto snap = [&](double t) {  // by differences of the acceleration, to one side
    return (path.at(t + h).acceleration[0] - 2 * path.at(t).acceleration[0] +
            path.at(t - h).acceleration[0]) /
           (h * h);
  };
  for (const double t : {0.7, 1.9}) {
    EXPECT_NEAR(snap(t - 2 * h), snap(t + 2 * h), 0.02 * std::abs(snap(t)) + 1.0);
    EXPECT_NEAR(path.at(t - 1e-9).velocity[0], path.at(t + 1e-9).velocity[0], 1e-6);
    EXPECT_NEAR(path.at(t - 1e-9).acceleration[0], path.at(t + 1e-9).acceleration[0], 1e-6);
  }
}

TEST(MinimumJerkPath, BegunAgainOnItsWayItIsTheSame) {
  const MinimumJerkPath path = path_through({0.4, -0.1, 0.2});
  constexpr double kNow = 1.1;
  const std::array<double, 2> times = {kTimes[1] - kNow, kTimes[2] - kNow};
  const std::array<Axes, 2> values = {Axes::Constant(-0.1), Axes::Constant(0.2)};
  MinimumJerkPath again;
  again.begin(path.at(kNow), times.data(), values.data(), 2);
  for (double t = 0.0; t < 1.6; t += 0.1) {
    EXPECT_NEAR(again.at(t).value[0], path.at(kNow + t).value[0], 1e-10) << t;
    EXPECT_NEAR(again.at(t).velocity[0], path.at(kNow + t).velocity[0], 1e-9) << t;
  }
}

TEST(PosePath, AngularVelocityIsThatOfTheOrientation) {
  GaitdMotion motion{};
  motion.axis_mask = 0b111111;
  motion.point_count = 2;
  motion.points[0] = {1.0, {0.1, 0.2, 0.3, 1.2, -0.7, 2.5}};
  motion.points[1] = {2.0, {0.0, 0.1, 0.0, -0.5, 0.4, -2.6}};
  PosePath::Sample start;
  start.orientation = sdk::from_roll_pitch_yaw(0.3, 0.2, -0.4);
  start.angular_velocity = {0.1, -0.2, 0.3};
  PosePath path;
  path.begin(start, motion, 0.0);
  constexpr double h = 1e-5;
  for (const double t : {0.0, 0.3, 0.9, 1.4, 1.8}) {
    const PosePath::Sample a = path.at(t), b = path.at(t + h);
    const Eigen::Vector3d rate = sdk::log_so3(b.orientation * a.orientation.conjugate()) / h;
    EXPECT_LT((rate - a.angular_velocity).norm(), 1e-3) << t;
    const Eigen::Vector3d change = (b.angular_velocity - a.angular_velocity) / h;
    EXPECT_LT((change - a.angular_acceleration).norm(), 0.05) << t;
  }
  EXPECT_LT(
      sdk::log_so3(path.at(2.0).orientation.conjugate() * sdk::from_roll_pitch_yaw(-0.5, 0.4, -2.6))
          .norm(),
      1e-9);
}

TEST(PosePath, WhatIsNotAskedForStays) {
  GaitdMotion motion{};
  motion.axis_mask = 0b000111;
  motion.point_count = 1;
  motion.points[0] = {1.0, {0.5, 0.0, 0.0, 1.0, 1.0, 1.0}};
  PosePath::Sample start;
  start.orientation = sdk::from_yaw(0.4);
  PosePath path;
  path.begin(start, motion, 0.0);
  EXPECT_NEAR(path.at(1.0).position.x(), 0.5, 1e-12);
  EXPECT_NEAR(sdk::yaw_of(path.at(1.0).orientation), 0.4, 1e-12);
}

}  // namespace
}  // namespace gaitd::walking
