// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "atlas_model.h"
#include "block_model.h"
#include "gaitd/sim/plant.h"

namespace gaitd::sim {
namespace {

struct Statistics {
  double mean = 0;
  double sigma = 0;
};

Statistics statistics(const std::vector<double>& x) {
  Statistics s;
  for (const double v : x) s.mean += v / static_cast<double>(x.size());
  for (const double v : x) s.sigma += (v - s.mean) * (v - s.mean) / static_cast<double>(x.size());
  s.sigma = std::sqrt(s.sigma);
  return s;
}

GaitdSensors sensors_of(const Plant& plant) {
  GaitdSensors sensors;
  plant.read(&sensors);
  return sensors;
}

TEST(Sensors, AtRestTheAccelerometerReadsGravityUpwardsAndTheWrenchesTheWeight) {
  const GaitdModel model = test::atlas_model();
  Plant plant(model, test::flat_config(model), 0.001);
  const GaitdJointCommands commands = test::hold_posture(model);
  GaitdSensors s = sensors_of(plant);
  EXPECT_NEAR(s.imus[0].specific_force[2], model.gravity, 1e-9);
  EXPECT_NEAR(s.feet[0].force[2] + s.feet[1].force[2], model.total_mass * model.gravity, 1e-6);
  for (int i = 0; i < 8000; ++i) ASSERT_TRUE(plant.advance(commands));
  s = sensors_of(plant);
  const GaitdTruth truth = [&] {
    GaitdTruth t;
    plant.read(&t);
    return t;
  }();
  EXPECT_NEAR(std::hypot(s.imus[0].specific_force[0], s.imus[0].specific_force[1],
                         s.imus[0].specific_force[2]),
              model.gravity, 2e-3);
  EXPECT_NEAR(s.feet[0].force[2] + s.feet[1].force[2], model.total_mass * model.gravity, 1.0);
  // Sole below the sensor: the moment is that of the centre of pressure.
  const double cop_x = -s.feet[0].moment[1] / s.feet[0].force[2];
  EXPECT_GT(cop_x, -0.09);
  EXPECT_LT(cop_x, 0.18);
  for (int j = 0; j < model.joint_count; ++j) {
    EXPECT_EQ(s.joints[j].position, truth.joint_position[j]);
    EXPECT_EQ(s.joints[j].velocity, truth.joint_velocity[j]);
    EXPECT_EQ(s.joints[j].torque, truth.joint_torque[j]);
    EXPECT_EQ(s.joints[j].info.valid, 1u);
    EXPECT_EQ(s.joints[j].info.age, 0);
  }
  EXPECT_EQ(s.imus[0].has_orientation, 0u);
  EXPECT_EQ(s.tick, 8000);
  EXPECT_EQ(s.imus[0].info.stamp_ns, 8000000000);
}

TEST(Sensors, ImuOnASpinningBodyFeelsItsOwnPlace) {
  GaitdModel model = test::block_model();
  model.imus[0].origin[0] = 0.3;
  Config config = test::block_config();
  Plant plant(model, config, 0.001);
  State state = test::block_state(0, 0, 5);
  state.u[2] = 4.0;  // about its axis of symmetry, in free fall
  plant.place(state);
  ASSERT_TRUE(test::run(&plant, 0.1));
  const GaitdSensors s = sensors_of(plant);
  EXPECT_NEAR(s.imus[0].angular_rate[2], 4.0, 1e-6);
  EXPECT_NEAR(s.imus[0].specific_force[0], -0.3 * 16, 0.02);
  EXPECT_NEAR(s.imus[0].specific_force[2], 0, 1e-6);
  EXPECT_NEAR(s.feet[0].force[2], 0, 1e-12);
}

TEST(Sensors, IntegratedSpecificForceIsTheVelocityAlsoThroughAnImpact) {
  Plant plant(test::block_model(), test::block_config(), 0.001);
  plant.place(test::block_state(0, 0, 0.05));
  double v = 0;
  for (int i = 0; i < 300; ++i) {
    ASSERT_TRUE(test::run(&plant, 0.001));
    v += 0.001 * (sensors_of(plant).imus[0].specific_force[2] - 9.81);
    ASSERT_NEAR(v, test::truth_of(plant).com_velocity[2], 1e-6);
  }
}

TEST(Sensors, NoiseAndBiasesHaveTheirFigures) {
  const GaitdModel model = test::atlas_model();
  Config config = test::flat_config(model);
  config.sensors = SensorFigures::nominal();
  const int kSamples = 4000;
  std::vector<double> gyro, acc, position, velocity, force, moment;
  Config ideal = test::flat_config(model);
  Plant noisy(model, config, 0.001);
  Plant exact(model, ideal, 0.001);
  const GaitdJointCommands commands = test::hold_posture(model);
  GaitdSensors late = sensors_of(exact);
  for (int i = 0; i < kSamples; ++i) {
    noisy.advance(commands);
    const GaitdSensors n = sensors_of(noisy);
    gyro.push_back(n.imus[0].angular_rate[0] - late.imus[0].angular_rate[0]);
    acc.push_back(n.imus[0].specific_force[1] - late.imus[0].specific_force[1]);
    position.push_back(n.joints[3].position - late.joints[3].position);
    velocity.push_back(n.joints[3].velocity);
    force.push_back(n.feet[1].force[2] - late.feet[1].force[2]);
    moment.push_back(n.feet[1].moment[0] - late.feet[1].moment[0]);
    exact.advance(commands);
    late = sensors_of(exact);
  }
  EXPECT_NEAR(statistics(gyro).sigma, 0.005, 0.0005);
  EXPECT_NEAR(statistics(acc).sigma, 0.05, 0.005);
  EXPECT_NEAR(statistics(position).sigma, 1e-4, 1e-5);
  EXPECT_NEAR(statistics(force).sigma, 5, 0.5);
  EXPECT_NEAR(statistics(moment).sigma, 0.5, 0.05);
  EXPECT_LT(std::abs(statistics(position).mean), 1e-5);
  // A differenced white error through a first-order filter.
  const double a = 1 - std::exp(-2 * std::numbers::pi * 100 * 0.0005);
  EXPECT_NEAR(statistics(velocity).sigma, a / 0.0005 * 1e-4 * std::sqrt(2 / (2 - a)), 0.006);
  const double bias[3] = {std::abs(statistics(gyro).mean) / 0.002,
                          std::abs(statistics(acc).mean) / 0.05,
                          std::abs(statistics(force).mean) / 15};
  for (const double b : bias) {
    EXPECT_GT(b, 1e-3);
    EXPECT_LT(b, 4);
  }
}

TEST(Sensors, BiasesSpreadOverSeedsWithTheirFigure) {
  const GaitdModel model = test::block_model();
  std::vector<double> bias;
  for (uint64_t seed = 0; seed < 300; ++seed) {
    Config config = test::block_config();
    config.seed = seed;
    config.sensors.gyro_bias = 0.002;
    const Plant plant(model, config, 0.001);
    for (const double x : sensors_of(plant).imus[0].angular_rate) bias.push_back(x);
  }
  EXPECT_NEAR(statistics(bias).sigma, 0.002, 0.0002);
  EXPECT_NEAR(statistics(bias).mean, 0, 0.0003);
}

TEST(Sensors, EncoderShowsWholeSteps) {
  const GaitdModel model = test::atlas_model();
  Config config = test::flat_config(model);
  config.sensors.encoder_bits = 12;
  Plant plant(model, config, 0.001);
  plant.advance(test::hold_posture(model));
  const double step = 2 * std::numbers::pi / 4096;
  for (int j = 0; j < model.joint_count; ++j) {
    const double steps = sensors_of(plant).joints[j].position / step;
    EXPECT_NEAR(steps, std::round(steps), 1e-6);
  }
}

TEST(Sensors, DelayIsExact) {
  const GaitdModel model = test::atlas_model();
  Config config = test::flat_config(model);
  config.sensors.delay = 0.003;
  Plant late(model, config, 0.001);
  Plant exact(model, test::flat_config(model), 0.001);
  const GaitdJointCommands commands = test::hold_posture(model);
  std::vector<GaitdSensors> past(1, sensors_of(exact));
  for (int i = 1; i <= 50; ++i) {
    late.advance(commands);
    exact.advance(commands);
    past.push_back(sensors_of(exact));
    const GaitdSensors now = sensors_of(late);
    const GaitdSensors& then = past[static_cast<size_t>(std::max(0, i - 3))];
    EXPECT_EQ(now.joints[5].position, then.joints[5].position);
    EXPECT_EQ(now.joints[5].velocity, then.joints[5].velocity);
    EXPECT_EQ(now.imus[0].specific_force[2], then.imus[0].specific_force[2]);
    EXPECT_EQ(now.feet[0].force[2], then.feet[0].force[2]);
    EXPECT_DOUBLE_EQ(now.joints[5].info.age, 0.003);
    EXPECT_EQ(now.joints[5].info.stamp_ns, (i - 3) * 1000000);
    EXPECT_EQ(now.tick, i);
  }
}

}  // namespace
}  // namespace gaitd::sim
