// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/joint_sensors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "atlas_model.h"

namespace gaitd::sim {
namespace {

constexpr double kStep = 0.0005;
constexpr double kDegree = std::numbers::pi / 180;

class JointSensorsTest : public testing::Test {
 protected:
  JointSensorsTest() : model_(test::atlas_model()) {
    const int n = model_.joint_count;
    state_.q = Eigen::VectorXd::LinSpaced(n, -0.3, 0.4);
    state_.u = Eigen::VectorXd::Zero(6 + n);
    drives_ = {Eigen::VectorXd::LinSpaced(n, -10, 20), Eigen::VectorXd::Zero(n),
               Eigen::VectorXd::LinSpaced(n, -2, 1)};
  }
  JointSensors sensors(const SensorFigures& figures, uint64_t seed = 1) const {
    JointSensors joints(model_, figures, kStep, seed);
    joints.reset(state_, drives_);
    return joints;
  }
  Eigen::VectorXd readings(const SensorFigures& figures, uint64_t seed = 1) const {
    JointSensors joints = sensors(figures, seed);
    joints.sample(state_, drives_);
    return joints.newest().position;
  }

  GaitdModel model_;
  State state_;
  DriveReadings drives_;
};

TEST_F(JointSensorsTest, WithoutErrorsTheyShowTheStateToTheBit) {
  state_.u.setLinSpaced(-1, 2);
  JointSensors joints = sensors(SensorFigures());
  joints.sample(state_, drives_);
  EXPECT_EQ(joints.newest().position, state_.q);
  EXPECT_EQ(joints.newest().velocity, state_.u.tail(model_.joint_count));
  EXPECT_EQ(joints.newest().torque, drives_.torque);
}

TEST_F(JointSensorsTest, TheZeroErrorIsOfTheJointAndStays) {
  SensorFigures figures;
  figures.joint_zero = 0.5 * kDegree;
  EXPECT_TRUE(readings(figures).isApprox(
      state_.q + Eigen::VectorXd::Constant(model_.joint_count, 0.5 * kDegree), 1e-12));
  figures.joint_zero = Draw::uniform(-0.01, 0.01);
  JointSensors joints = sensors(figures);
  joints.sample(state_, drives_);
  const Eigen::VectorXd first = joints.newest().position;
  for (int i = 0; i < 100; ++i) joints.sample(state_, drives_);
  EXPECT_EQ(joints.newest().position, first);
  EXPECT_EQ(joints.newest().velocity, Eigen::VectorXd::Zero(model_.joint_count));
  std::set<double> different;
  for (int j = 0; j < model_.joint_count; ++j) different.insert(first[j] - state_.q[j]);
  EXPECT_EQ(different.size(), static_cast<size_t>(model_.joint_count));
}

TEST_F(JointSensorsTest, TorqueSensorsOfRoughRobotsAreTwiceAsWrong) {
  SensorFigures figures;
  const Eigen::VectorXd real = drives_.torque + drives_.torque_error;
  EXPECT_EQ(sensors(figures).newest().torque, drives_.torque);
  figures.torque_error = SensorFigures::rough().torque_error;
  JointSensors joints = sensors(figures);
  for (int i = 0; i < 2; ++i) {
    const Eigen::VectorXd error = joints.newest().torque - real;
    EXPECT_TRUE(error.isApprox(-2 * drives_.torque_error, 1e-12)) << error.transpose();
    drives_.torque_error *= 0.5;
    drives_.torque = real - drives_.torque_error;
    joints.sample(state_, drives_);
  }
  EXPECT_TRUE(SensorFigures::lab().torque_error.zero());
}

TEST_F(JointSensorsTest, NoiseIsOfTheEpisodeAndErrorsAreOfTheRobot) {
  SensorFigures figures;
  figures.joint_zero = Draw::uniform(-0.01, 0.01);
  const auto shown = [&](const SensorSeed& seed) {
    JointSensors joints(model_, figures, kStep, seed);
    joints.reset(state_, drives_);
    return joints.newest().position;
  };
  EXPECT_EQ(shown({1, 1}), shown(1));
  figures.encoder_noise = 1e-4;
  EXPECT_EQ(shown({1, 0}), shown(1));
  EXPECT_EQ(shown({1, 1}), shown({1, 1}));
  EXPECT_NE(shown({1, 1}), shown(1));
  EXPECT_NE(shown({1, 1}), shown({1, 2}));
}

TEST_F(JointSensorsTest, ZeroErrorsOfManyRobotsHaveTheirFigures) {
  double sum = 0, worst = 0, worst_lab = 0, cut = 0;
  int count = 0;
  SensorFigures lab, rough;
  lab.joint_zero = SensorFigures::lab().joint_zero;
  rough.joint_zero = SensorFigures::rough().joint_zero;
  for (uint64_t seed = 0; seed < 300; ++seed) {
    const Eigen::VectorXd error = readings(rough, seed) - state_.q;
    sum += error.squaredNorm();
    count += model_.joint_count;
    worst = std::max(worst, error.cwiseAbs().maxCoeff());
    cut += static_cast<double>((error.array().abs() > 0.0499999).count());
    worst_lab = std::max(worst_lab, (readings(lab, seed) - state_.q).cwiseAbs().maxCoeff());
  }
  EXPECT_NEAR(std::sqrt(sum / count), 1.0 * kDegree, 0.03 * kDegree);
  EXPECT_NEAR(worst, 0.05, 1e-9);
  EXPECT_NEAR(cut / count, 0.0042, 0.002);  // beyond 2.86 sigma
  EXPECT_NEAR(worst_lab, 0.01, 1e-4);
}

TEST_F(JointSensorsTest, TheEncoderSitsOnTheSideOfTheMotor) {
  SensorFigures figures;
  drives_.deflection.setLinSpaced(-0.02, 0.03);
  EXPECT_TRUE(readings(figures).isApprox(state_.q + drives_.deflection, 1e-12));

  // Its speed, too: exact, and by difference.
  for (const double filter : {0.0, 50.0}) {
    figures.velocity_filter = filter;
    JointSensors joints = sensors(figures);
    for (int i = 0; i < 400; ++i) {
      state_.q.array() += 0.3 * kStep;
      state_.u.tail(model_.joint_count).setConstant(0.3);
      drives_.deflection.array() += 0.2 * kStep;
      joints.sample(state_, drives_);
    }
    EXPECT_TRUE(joints.newest().velocity.isApproxToConstant(0.5, 1e-9));
  }
}

TEST_F(JointSensorsTest, SpeedComesThroughItsFilter) {
  SensorFigures figures;
  figures.velocity_filter = 25;
  JointSensors joints = sensors(figures);
  const double time = 1 / (2 * std::numbers::pi * 25);
  const int steps = static_cast<int>(std::lround(time / kStep));
  for (int i = 0; i < steps; ++i) {
    state_.q.array() += 1.0 * kStep;
    joints.sample(state_, drives_);
  }
  EXPECT_NEAR(joints.newest().velocity[3], 1 - std::exp(-steps * kStep / time), 1e-9);
}

TEST_F(JointSensorsTest, StepsAndNoiseHaveTheirFigures) {
  SensorFigures figures;
  figures.encoder_bits = 14;
  const double tick = 2 * std::numbers::pi / 16384;
  const Eigen::VectorXd shown = readings(figures);
  for (int j = 0; j < model_.joint_count; ++j) {
    EXPECT_NEAR(shown[j] / tick, std::round(shown[j] / tick), 1e-6);
    EXPECT_LE(std::abs(shown[j] - state_.q[j]), 0.5 * tick + 1e-12);
  }
  figures = SensorFigures();
  figures.encoder_noise = 3e-4;
  JointSensors joints = sensors(figures);
  double sum = 0;
  for (int i = 0; i < 2000; ++i) {
    joints.sample(state_, drives_);
    sum += (joints.newest().position - state_.q).squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(sum / (2000 * model_.joint_count)), 3e-4, 1e-5);
}

TEST_F(JointSensorsTest, SpikesAreRareFarOffAndShort) {
  SensorFigures figures;
  figures.spike_rate = 1;
  figures.spike_size = 20 * kDegree;
  JointSensors joints = sensors(figures);
  const int kSamples = 100000;  // 50 s
  std::vector<int> length(static_cast<size_t>(model_.joint_count));
  int spikes = 0, up = 0, wrong_length = 0;
  for (int i = 0; i < kSamples; ++i) {
    joints.sample(state_, drives_);
    for (int j = 0; j < model_.joint_count; ++j) {
      const double off = joints.newest().position[j] - state_.q[j];
      int& now = length[static_cast<size_t>(j)];
      if (std::abs(off) > 1e-9) {
        EXPECT_NEAR(std::abs(off), 20 * kDegree, 1e-9);
        if (now++ == 0) up += off > 0;
      } else if (now > 0) {
        ++spikes;
        wrong_length += now != 4;
        now = 0;
      }
    }
  }
  const double expected = 50.0 * model_.joint_count;
  EXPECT_NEAR(spikes, expected, 0.1 * expected);
  EXPECT_NEAR(up, 0.5 * spikes, 0.06 * spikes);
  EXPECT_LE(wrong_length, 0.01 * spikes);  // two in a row
}

TEST_F(JointSensorsTest, OneErrorChangesNothingOfTheOthers) {
  SensorFigures zero, all;
  zero.joint_zero = all.joint_zero = Draw::normal(0.02, 0.05);
  all.spike_rate = 5;
  all.spike_size = 0.1;
  all.velocity_filter = Draw::uniform(10, 50);
  EXPECT_EQ(readings(zero), readings(all));
}

}  // namespace
}  // namespace gaitd::sim
