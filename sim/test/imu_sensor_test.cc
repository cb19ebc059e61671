// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/imu_sensor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "block_model.h"
#include "multibody.h"

namespace gaitd::sim {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 0.0005;
constexpr double kDegree = std::numbers::pi / 180;

class ImuSensorTest : public testing::Test {
 protected:
  ImuSensorTest() : model_(test::block_model()), multibody_(model_) { move(Vector3d::Zero()); }
  void move(const Vector3d& rate) {
    State state = test::block_state(0, 0, 1);
    state.u.head<3>() = rate;
    multibody_.set_state(state);
  }
  ImuSensor sensor(const SensorFigures& figures, const SensorSeed& seed = 1,
                   double time_step = kStep) {
    ImuSensor imu(model_, 0, figures, time_step, 2, seed);
    imu.reset(multibody_.bodies());
    return imu;
  }
  ImuReading reading(const SensorFigures& figures, const SensorSeed& seed = 1) {
    ImuSensor imu = sensor(figures, seed);
    imu.sample(multibody_.bodies());
    return imu.newest();
  }

  GaitdModel model_;
  Multibody multibody_;
};

TEST(LowPass, StepResponseIsExactWhateverTheStep) {
  for (const double frequency : {80.0, 250.0}) {
    for (const double h : {0.00025, 0.0005, 0.001}) {
      LowPass filter(frequency, h);
      filter.reset(Vector3d::Zero());
      const double s = 2 * std::numbers::pi * frequency / std::numbers::sqrt2;
      for (int i = 1; i < 40; ++i) {
        const double t = i * h;
        const double expected = 1 - std::exp(-s * t) * (std::cos(s * t) + std::sin(s * t));
        EXPECT_NEAR(filter.filter(Vector3d(1, -2, 0)).x(), expected, 1e-12);
      }
    }
  }
  LowPass fast(1e5, 0.0005);  // far above the sampling rate
  for (int i = 0; i < 100; ++i) EXPECT_NEAR(fast.filter(Vector3d::Ones()).x(), 1, 0.05);
}

TEST(LowPass, HalvesThePowerAtItsFrequency) {
  const double h = 1e-5, frequency = 80;
  LowPass filter(frequency, h);
  double largest = 0;
  for (int i = 0; i < 20000; ++i) {
    const double x = std::sin(2 * std::numbers::pi * frequency * i * h);
    const double y = filter.filter(Vector3d(x, 0, 0)).x();
    if (i > 10000) largest = std::max(largest, y);
  }
  EXPECT_NEAR(largest, 1 / std::numbers::sqrt2, 0.005);
}

TEST_F(ImuSensorTest, WithoutErrorsItShowsTheMotion) {
  move(Vector3d(0.1, -0.2, 0.3));
  const ImuReading shown = reading(SensorFigures());
  EXPECT_LT((shown.angular_rate - Vector3d(0.1, -0.2, 0.3)).norm(), 1e-15);
  EXPECT_LT((shown.specific_force - Vector3d(0, 0, model_.gravity)).norm(), 1e-12);
}

TEST_F(ImuSensorTest, ReadingsHaveTheFiguresAlsoBehindTheFilter) {
  SensorFigures figures;
  figures.gyro_noise = 5e-3;
  figures.accelerometer_noise = 0.1;
  figures.imu_filter = 80;
  ImuSensor imu = sensor(figures);
  double rate = 0, force = 0, together = 0;
  Vector3d last = Vector3d::Zero();
  const int kReadings = 10000;
  for (int i = 0; i < kReadings; ++i) {
    imu.sample(multibody_.bodies());
    imu.sample(multibody_.bodies());  // two samples in a period of 1 ms
    const Vector3d error = imu.newest().specific_force - Vector3d(0, 0, model_.gravity);
    rate += imu.newest().angular_rate.squaredNorm() / (3 * kReadings);
    force += error.squaredNorm() / (3 * kReadings);
    together += error.dot(last) / (3 * kReadings);
    last = error;
  }
  EXPECT_NEAR(std::sqrt(rate), 5e-3, 1e-4);
  EXPECT_NEAR(std::sqrt(force), 0.1, 2e-3);
  EXPECT_NEAR(together / force, 0, 0.03);  // white
}

double allan_deviation(const std::vector<double>& x, size_t cluster) {
  std::vector<double> mean(x.size() / cluster);
  for (size_t i = 0; i < mean.size(); ++i) {
    for (size_t k = 0; k < cluster; ++k) {
      mean[i] += x[i * cluster + k] / static_cast<double>(cluster);
    }
  }
  double sum = 0;
  for (size_t i = 1; i < mean.size(); ++i) sum += std::pow(mean[i] - mean[i - 1], 2);
  return std::sqrt(0.5 * sum / static_cast<double>(mean.size() - 1));
}

TEST_F(ImuSensorTest, AllanDeviationShowsDensityAndWalk) {
  const double kNoise = 3e-4, kWalk = 1e-5, kPeriod = 0.01;
  SensorFigures figures;
  figures.gyro_noise = kNoise;
  figures.gyro_walk = kWalk;
  figures.gyro_bias = 1e-4;
  ImuSensor imu = sensor(figures, 5, kPeriod);
  std::vector<double> axes[3];
  for (int i = 0; i < 2000000; ++i) {
    imu.sample(multibody_.bodies());
    for (int k = 0; k < 3; ++k) axes[k].push_back(imu.newest().angular_rate[k]);
  }
  for (const double time : {1.0, 100.0}) {
    double variance = 0;
    for (const auto& axis : axes) {
      variance += std::pow(allan_deviation(axis, static_cast<size_t>(time / kPeriod)), 2) / 3;
    }
    const double density = kNoise * std::sqrt(kPeriod);
    const double expected = std::sqrt(density * density / time + kWalk * kWalk * time / 3);
    EXPECT_NEAR(std::sqrt(variance), expected, 0.1 * expected) << time;
  }
}

TEST_F(ImuSensorTest, ScaleAndMisalignmentHaveTheirFigures) {
  SensorFigures turned, scaled;
  turned.imu_misalignment = 1 * kDegree;
  scaled.imu_scale = 0.007;
  double angle = 0, scale = 0;
  for (uint64_t seed = 0; seed < 300; ++seed) {
    const Vector3d force = reading(turned, seed).specific_force;
    EXPECT_NEAR(force.norm(), model_.gravity, 1e-9);
    angle += std::pow(std::atan2(force.x(), force.z()), 2) / 300;
    scale += std::pow(reading(scaled, seed).specific_force.z() / model_.gravity - 1, 2) / 300;
  }
  EXPECT_NEAR(std::sqrt(angle), 1 * kDegree, 0.1 * kDegree);
  EXPECT_NEAR(std::sqrt(scale), 0.007, 0.0007);

  // Gyro and accelerometers sit on the same board.
  const Vector3d up = reading(turned).specific_force.normalized();
  move(Vector3d(0, 0, 2));
  EXPECT_LT((reading(turned).angular_rate.normalized() - up).norm(), 1e-9);
}

TEST_F(ImuSensorTest, SpecificForceBeyondThatOfStandingTurnsTheGyro) {
  SensorFigures figures;
  figures.gyro_g_sensitivity = 2e-4;
  double sum = 0;
  for (uint64_t seed = 0; seed < 300; ++seed) {
    move(Vector3d::Zero());
    ImuSensor imu = sensor(figures, seed);
    imu.sample(multibody_.bodies());
    EXPECT_EQ(imu.newest().angular_rate, Vector3d::Zero());
    State state = test::block_state(0, 0, 1);
    state.u[3] = 10 * 2 * kStep;  // 10 m/s^2 over the period
    multibody_.set_state(state);
    imu.sample(multibody_.bodies());
    sum += imu.newest().angular_rate.squaredNorm() / 900;
  }
  EXPECT_NEAR(std::sqrt(sum), 2e-3, 2e-4);
}

TEST_F(ImuSensorTest, AStrikeRingsAndDiesAway) {
  SensorFigures figures;
  figures.strike_vibration = 30;
  figures.strike_rotation = 0.1;
  figures.strike_frequency = 50;
  ImuSensor imu = sensor(figures);
  const Vector3d still(0, 0, model_.gravity);
  imu.sample(multibody_.bodies());
  EXPECT_EQ(imu.newest().angular_rate, Vector3d::Zero());
  imu.strike(0.1);
  for (int i = 1; i <= 400; ++i) {
    imu.sample(multibody_.bodies());
    const double t = i * kStep;
    const double expected = std::exp(-t / 0.02) * std::sin(2 * std::numbers::pi * 50 * t);
    EXPECT_NEAR((imu.newest().specific_force - still).norm(), 3 * std::abs(expected), 1e-9);
    EXPECT_NEAR(imu.newest().angular_rate.norm(), 0.01 * std::abs(expected), 1e-12);
  }
  EXPECT_LT((imu.newest().specific_force - still).norm(), 1e-3);

  // Two strikes add up, and the filter of the IMU sees them.
  double peak = 0, filtered = 0;
  for (const double filter : {0.0, 20.0}) {
    figures.imu_filter = filter;
    ImuSensor twice = sensor(figures);
    double& largest = filter > 0 ? filtered : peak;
    for (int i = 0; i < 100; ++i) {
      if (i == 0 || i == 40) twice.strike(0.1);  // one period of 20 ms apart
      twice.sample(multibody_.bodies());
      if (i >= 40) {
        largest = std::max(largest, (twice.newest().specific_force - still).norm());
      }
    }
  }
  EXPECT_GT(peak, 2.4 * (1 - std::exp(-1)));
  EXPECT_LT(filtered, 0.4 * peak);
}

TEST_F(ImuSensorTest, BiasIsOfTheEpisodeAndScaleOfTheRobot) {
  SensorFigures figures;
  figures.imu_scale = 0.007;
  figures.imu_misalignment = kDegree;
  EXPECT_EQ(reading(figures, {1, 1}).specific_force, reading(figures, 1).specific_force);
  figures.gyro_bias = 5e-3;
  figures.accelerometer_bias = 0.3;
  EXPECT_EQ(reading(figures, {1, 0}).specific_force, reading(figures, 1).specific_force);
  EXPECT_NE(reading(figures, {1, 1}).specific_force, reading(figures, 1).specific_force);
  EXPECT_NE(reading(figures, {1, 1}).angular_rate, reading(figures, {1, 2}).angular_rate);
}

TEST_F(ImuSensorTest, OneErrorChangesNothingOfTheOthers) {
  SensorFigures bias;
  bias.accelerometer_bias = 0.3;
  const Vector3d alone = reading(bias).specific_force;
  bias.gyro_bias = 0.1;
  bias.gyro_walk = 0.01;
  bias.gyro_noise = 0.01;
  bias.strike_vibration = 30;
  EXPECT_EQ(reading(bias).specific_force, alone);
}

}  // namespace
}  // namespace gaitd::sim
