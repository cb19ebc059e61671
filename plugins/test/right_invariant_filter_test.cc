// SPDX-License-Identifier: Apache-2.0
// The filter by itself, against motions that are known exactly.
#include "right_invariant_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "gaitd/sdk/views.h"
#include "walking/test/tick.h"

namespace gaitd::plugins {
namespace {

using testing::kDt;

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Filter = RightInvariantFilter;

constexpr double kGravity = 9.81;

const Vector3d kRate(0.3, -0.5, 0.8);          // rad/s, constant
const Vector3d kAcceleration(0.4, -0.2, 0.3);  // m/s^2, W, constant
const Vector3d kPoint(0.2, 0.1, -0.9);         // m, W, at rest

// A body that turns and accelerates steadily.
struct Motion {
  Quaterniond R = Quaterniond::Identity();
  Vector3d v = Vector3d(0.5, 0.0, 0.0), p = Vector3d(0.0, 0.0, 0.0);

  Vector3d specific_force() const {
    const Quaterniond middle = R * sdk::exp_so3(0.5 * kDt * kRate);
    return middle.conjugate() * (kAcceleration + Vector3d(0, 0, kGravity));
  }
  void step() {
    p += kDt * v + 0.5 * kDt * kDt * kAcceleration;
    v += kDt * kAcceleration;
    R = R * sdk::exp_so3(kDt * kRate);
  }
  Vector3d seen(const Vector3d& point) const { return R.conjugate() * (point - p); }
};

Filter::Noise noise() { return {3e-4, 0.01, 2e-5, 5e-4, 1e-3, 1e-3}; }

TEST(RightInvariantFilter, PredictsAMotionExactly) {
  Filter filter(kGravity);
  filter.reset();
  Motion motion;
  filter.velocity = motion.v;
  for (int i = 0; i < 2000; ++i) {
    filter.predict(kRate, motion.specific_force(), kDt, noise());
    motion.step();
  }
  EXPECT_LT((filter.position - motion.p).norm(), 1e-9);
  EXPECT_LT((filter.velocity - motion.v).norm(), 1e-9);
  EXPECT_LT(filter.orientation.angularDistance(motion.R), 1e-9);
}

// What makes the filter invariant: an error about the vertical moves on as the linear model says
// however large it is, so that a wrong heading never looks like anything that contacts could tell.
TEST(RightInvariantFilter, AWrongHeadingIsNoInnovation) {
  Filter filter(kGravity);
  filter.reset();
  const Quaterniond wrong = sdk::from_yaw(1.2);
  Motion motion;
  filter.orientation = wrong;
  filter.velocity = wrong * motion.v;
  filter.covariance.topLeftCorner<6, 6>().setIdentity();
  filter.add_point(0, motion.seen(kPoint), 1e-3);
  filter.add_point(1, motion.seen(-kPoint), 1e-3);
  for (int i = 0; i < 1000; ++i) {
    filter.predict(kRate, motion.specific_force(), kDt, noise());
    motion.step();
    filter.correct_point(0, motion.seen(kPoint), 1e-3);
    filter.correct_point(1, motion.seen(-kPoint), 1e-3);
  }
  EXPECT_LT(filter.orientation.angularDistance(wrong * motion.R), 1e-6);
  EXPECT_LT((filter.position - wrong * motion.p).norm(), 1e-6);
  EXPECT_LT(filter.gyro_bias.norm() + filter.accelerometer_bias.norm(), 1e-6);
}

TEST(RightInvariantFilter, APointOfContactShowsVelocityTiltAndBiases) {
  Filter filter(kGravity);
  filter.reset();
  Motion motion;
  const Vector3d gyro_bias(0.004, -0.003, 0.002);
  filter.orientation = sdk::exp_so3(Vector3d(0.05, -0.04, 0.0));
  filter.velocity = motion.v + Vector3d(0.1, -0.1, 0.05);
  const Vector3d spread(0.05, 0.05, 1e-6);  // the heading is known
  filter.covariance.diagonal().segment<3>(Filter::kOrientation) = spread.cwiseAbs2();
  filter.covariance.diagonal().segment<3>(Filter::kVelocity).setConstant(0.01);
  filter.covariance.diagonal().segment<3>(Filter::kGyroBias).setConstant(1e-4);
  filter.add_point(2, motion.seen(kPoint), 1e-4);
  for (int i = 0; i < 8000; ++i) {
    filter.predict(kRate + gyro_bias, motion.specific_force(), kDt, noise());
    motion.step();
    filter.correct_point(2, motion.seen(kPoint), 1e-4);
  }
  const Vector3d up = filter.orientation.conjugate() * Vector3d::UnitZ();
  EXPECT_LT((up - motion.R.conjugate() * Vector3d::UnitZ()).norm(), 1e-3);
  EXPECT_LT(
      (filter.orientation.conjugate() * filter.velocity - motion.R.conjugate() * motion.v).norm(),
      0.01);
  EXPECT_LT((filter.gyro_bias - gyro_bias).norm(), 1e-3);
}

// Errors over many runs against what the covariance says of them.
TEST(RightInvariantFilter, KnowsHowWrongItIs) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const auto draw = [&](double sigma) {
    return Vector3d(sigma * normal(random), sigma * normal(random), sigma * normal(random));
  };
  const Filter::Noise n = noise();
  const double per_sample = 1.0 / std::sqrt(kDt);
  constexpr double kSigma = 2e-3;
  constexpr int kRuns = 60;
  double sum = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    Filter filter(kGravity);
    filter.reset();
    Motion motion;
    const Vector3d turn = draw(0.02), velocity = draw(0.1);
    filter.orientation = sdk::exp_so3(turn) * motion.R;
    filter.velocity = sdk::exp_so3(turn) * motion.v + velocity;
    filter.covariance.diagonal().segment<3>(Filter::kOrientation).setConstant(0.02 * 0.02);
    filter.covariance.diagonal().segment<3>(Filter::kVelocity).setConstant(0.1 * 0.1);
    filter.add_point(0, motion.seen(kPoint) + draw(kSigma), kSigma);
    Vector3d foot = kPoint;
    for (int i = 0; i < 500; ++i) {
      filter.predict(kRate + draw(n.gyro * per_sample),
                     motion.specific_force() + draw(n.accelerometer * per_sample), kDt, n);
      motion.step();
      foot += draw(n.foot_horizontal * std::sqrt(kDt));
      filter.correct_point(0, motion.seen(foot) + draw(kSigma), kSigma);
    }
    const Vector3d error = filter.velocity - motion.v;
    sum += error.dot(filter.velocity_covariance().inverse() * error) / 3.0;
  }
  EXPECT_GT(sum / kRuns, 0.7);
  EXPECT_LT(sum / kRuns, 1.4);
}

TEST(RightInvariantFilter, WithoutContactsItKnowsLessAndLess) {
  Filter filter(kGravity);
  filter.reset();
  Motion motion;
  filter.velocity = motion.v;
  filter.add_point(3, motion.seen(kPoint), 1e-3);
  const auto spread = [&] { return filter.velocity_covariance().trace(); };
  const auto run = [&] {
    for (int i = 0; i < 1000; ++i) {
      filter.predict(kRate, motion.specific_force(), kDt, noise());
      motion.step();
      filter.correct_point(3, motion.seen(kPoint), 1e-3);
    }
  };
  run();
  const double held = spread();
  filter.remove_point(3);
  EXPECT_FALSE(filter.has_point(3));
  run();
  EXPECT_GT(spread(), 4.0 * held);
  filter.add_point(3, motion.seen(kPoint), 1e-3);
  run();
  EXPECT_LT(spread(), 2.0 * held);
}

TEST(RightInvariantFilter, ATiltThatIsMeasuredLeavesTheHeading) {
  Filter filter(kGravity);
  filter.reset();
  filter.orientation = sdk::from_yaw(0.7);
  filter.covariance.diagonal().head<3>().setConstant(0.1);
  const Quaterniond measured = sdk::exp_so3(Vector3d(0.05, -0.03, 0.2)) * filter.orientation;
  filter.correct_tilt(measured, 1e-4);
  const Vector3d left = sdk::log_so3(measured * filter.orientation.conjugate());
  EXPECT_NEAR(left.x(), 0.0, 0.01);
  EXPECT_NEAR(left.y(), 0.0, 0.01);
  EXPECT_NEAR(left.z(), 0.2, 0.01);
}

// Feet give way to each side by millimetres, but hardly turn: what they tell of the gyroscope about
// the vertical must not drown in the former.
TEST(RightInvariantFilter, FeetThatMoveButDoNotTurnTellTheBiasAboutTheVertical) {
  Filter filter(kGravity);
  filter.reset();
  const Vector3d bias(0.0, 0.0, 0.004), up(0.0, 0.0, kGravity);
  const double sigma = 2e-3;
  filter.covariance.diagonal().segment<3>(Filter::kGyroBias).setConstant(16e-6);
  Filter::Noise walking = noise();
  walking.foot_horizontal = walking.point_vertical = 0.004;
  walking.foot_turn = 4e-3;
  const Vector3d ahead(0.1, 0.1, -0.9), behind(-0.1, 0.1, -0.9);
  for (int i = 0; i < 20000; ++i) {
    filter.predict(bias, up, kDt, walking);
    const Vector3d sideways(0.0, 0.002 * std::sin(0.002 * M_PI * i), 0.0);
    if (i % 700 == 0) {
      filter.add_point(0, ahead + sideways, sigma);
      filter.add_point(1, behind + sideways, sigma);
    }
    filter.correct_point(0, ahead + sideways, sigma);
    filter.correct_point(1, behind + sideways, sigma);
  }
  EXPECT_NEAR(filter.gyro_bias.z(), bias.z(), 1e-3);
}

// A minute of steps with a gyroscope that is wrong about the vertical, then it stands: the bias
// shows, and with it where the heading should have been. Nothing in W may move for that.
TEST(RightInvariantFilter, WhatItLearnsOfTheGyroscopeMovesNothing) {
  Filter filter(kGravity);
  filter.reset();
  const Vector3d bias(0.0, 0.0, 0.001);
  const Vector3d up(0.0, 0.0, kGravity);
  const double sigma = 2e-3;
  filter.position = Vector3d(5.0, -3.0, 1.0);
  filter.covariance.diagonal().segment<3>(Filter::kGyroBias).setConstant(25e-6);
  filter.covariance.diagonal().segment<3>(Filter::kVelocity).setConstant(4e-4);
  Filter::Noise loose = noise();
  loose.foot_horizontal = loose.point_vertical = 0.02;
  loose.foot_turn = 0.1;
  const Vector3d ahead(0.1, 0.1, -0.9), behind(-0.1, 0.1, -0.9);
  for (int i = 0; i < 60000; ++i) {
    filter.predict(bias, up, kDt, loose);
    if (i % 500 == 0) {
      filter.add_point(0, ahead, sigma);
      filter.add_point(1, behind, sigma);
    }
    filter.correct_point(0, ahead, sigma);
    filter.correct_point(1, behind, sigma);
  }
  Filter::Noise firm = loose;
  firm.foot_horizontal = firm.point_vertical = 1e-4;
  firm.foot_turn = 5e-4;
  const Vector3d place = filter.position, point = filter.point(0);
  const double heading = sdk::yaw_of(filter.orientation);
  const double unknown = (filter.gyro_bias - bias).norm();
  for (int i = 0; i < 5000; ++i) {
    filter.predict(bias, up, kDt, firm);
    filter.correct_point(0, ahead, sigma);
    filter.correct_point(1, behind, sigma);
  }
  EXPECT_LT((filter.gyro_bias - bias).norm(), 0.5 * unknown);
  EXPECT_LT((filter.point(0) - point).norm(), 2e-3);
  EXPECT_LT((filter.position - place).norm(), 2e-3);
  EXPECT_LT(std::abs(sdk::yaw_of(filter.orientation) - heading), 5e-3);
}

}  // namespace
}  // namespace gaitd::plugins
