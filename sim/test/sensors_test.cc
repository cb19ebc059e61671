// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include "atlas_model.h"
#include "block_model.h"
#include "gaitd/sim/plant.h"
#include "simbody_plant.h"

namespace gaitd::sim {
namespace {

using test::SimbodyPlant;

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
  SimbodyPlant plant(model, test::flat_config(model), 0.001);
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
  SimbodyPlant plant(model, config, 0.001);
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
  SimbodyPlant plant(test::block_model(), test::block_config(), 0.001);
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
  SimbodyPlant noisy(model, config, 0.001);
  SimbodyPlant exact(model, ideal, 0.001);
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
    const SimbodyPlant plant(model, config, 0.001);
    for (const double x : sensors_of(plant).imus[0].angular_rate) bias.push_back(x);
  }
  EXPECT_NEAR(statistics(bias).sigma, 0.002, 0.0002);
  EXPECT_NEAR(statistics(bias).mean, 0, 0.0003);
}

TEST(Sensors, EncoderShowsWholeSteps) {
  const GaitdModel model = test::atlas_model();
  Config config = test::flat_config(model);
  config.sensors.encoder_bits = 12;
  SimbodyPlant plant(model, config, 0.001);
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
  config.sensors.set_delay(0.003);
  SimbodyPlant late(model, config, 0.001);
  SimbodyPlant exact(model, test::flat_config(model), 0.001);
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

Eigen::Vector3d center_of_mass(const GaitdModel& model, const Multibody& multibody) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < model.body_count; ++i) {
    sum += model.bodies[i].mass * multibody.body(i).point(Eigen::Vector3d(model.bodies[i].com));
  }
  return sum / model.total_mass;
}

// The robot whose joints are at `q`, its left foot at rest in the origin.
Eigen::Vector3d center_of_mass_over_foot(const GaitdModel& model, const Eigen::VectorXd& q) {
  Multibody multibody(model);
  State state;
  state.q = q;
  state.u = Eigen::VectorXd::Zero(6 + model.joint_count);
  multibody.set_state(state);
  const BodyMotion& foot = multibody.body(model.feet[GAITD_LEFT].body);
  return foot.R_WB.transpose() * (center_of_mass(model, multibody) - foot.p_WB);
}

TEST(Sensors, AZeroErrorOfTheAnkleMovesTheEstimatedCenterOfMass) {
  const GaitdModel model = test::atlas_model();
  Config config = test::flat_config(model);
  config.sensors.joint_zero = 0.5 * std::numbers::pi / 180;
  const SimbodyPlant plant(model, config, 0.001);
  const int ankle = model.legs[GAITD_LEFT].ankle_pitch;
  Eigen::VectorXd shown = plant.state().q;
  shown[ankle] = sensors_of(plant).joints[ankle].position;
  const double error =
      (center_of_mass_over_foot(model, shown) - center_of_mass_over_foot(model, plant.state().q))
          .norm();
  EXPECT_NEAR(error, 0.009, 0.2 * 0.009);
  GaitdTruth truth;
  plant.read(&truth);
  EXPECT_EQ(truth.joint_position[ankle], plant.state().q[ankle]);
}

std::vector<GaitdSensors> run_rough(Plant* plant, const GaitdModel& model) {
  std::vector<GaitdSensors> readings;
  const GaitdJointCommands commands = test::hold_posture(model);
  for (int i = 0; i < 150; ++i) {
    plant->advance(commands);
    readings.push_back(sensors_of(*plant));
  }
  return readings;
}

TEST(Sensors, TheSameSeedShowsTheSameBitsAndAnotherOneOthers) {
  const GaitdModel model = test::atlas_model();
  Config config = test::flat_config(model);
  config.sensors = SensorFigures::rough();
  SimbodyPlant plant(model, config, 0.001);
  const auto first = run_rough(&plant, model);
  plant.reset();
  const auto again = run_rough(&plant, model);
  SimbodyPlant twin(model, config, 0.001);
  const auto same = run_rough(&twin, model);
  config.seed = 2;
  SimbodyPlant other(model, config, 0.001);
  const auto different = run_rough(&other, model);
  for (size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(std::memcmp(&first[i], &again[i], sizeof(GaitdSensors)), 0) << i;
    EXPECT_EQ(std::memcmp(&first[i], &same[i], sizeof(GaitdSensors)), 0) << i;
    EXPECT_NE(first[i].joints[0].position, different[i].joints[0].position);
    EXPECT_NE(first[i].feet[0].force[2], different[i].feet[0].force[2]);
  }
}

TEST(Sensors, AnotherSensorChangesNothingOfTheRest) {
  GaitdModel model = test::atlas_model();
  Config config = test::flat_config(model);
  config.sensors = SensorFigures::rough();
  SimbodyPlant one(model, config, 0.001);
  const auto alone = run_rough(&one, model);
  model.imu_count = 2;
  model.imus[1] = model.imus[0];
  SimbodyPlant two(model, config, 0.001);
  const auto together = run_rough(&two, model);
  for (size_t i = 0; i < alone.size(); ++i) {
    const GaitdSensors &a = alone[i], &b = together[i];
    EXPECT_EQ(std::memcmp(a.joints, b.joints, sizeof(a.joints)), 0);
    EXPECT_EQ(std::memcmp(a.feet, b.feet, sizeof(a.feet)), 0);
    EXPECT_EQ(std::memcmp(&a.imus[0], &b.imus[0], sizeof(a.imus[0])), 0);
    // Its own errors, not those of the first.
    EXPECT_NE(b.imus[0].angular_rate[0], b.imus[1].angular_rate[0]);
  }
}

TEST(Sensors, EachKindIsAsLateAsItsOwnFigure) {
  const GaitdModel model = test::atlas_model();
  Config config = test::flat_config(model);
  config.sensors.joint_delay = 0.002;
  config.sensors.imu_delay = 0.003;
  config.sensors.foot_delay = 0.0005;
  SimbodyPlant plant(model, config, 0.001);
  plant.advance(test::hold_posture(model));
  const GaitdSensors s = sensors_of(plant);
  EXPECT_EQ(s.joints[4].info.age, 0.002);
  EXPECT_EQ(s.imus[0].info.age, 0.003);
  EXPECT_EQ(s.feet[1].info.age, 0.0005);
}

TEST(Sensors, TheBoardOfADriveSeesTheEncoderAtOnce) {
  const GaitdModel model = test::atlas_model();
  SensorFigures figures;
  figures.set_delay(0.005);
  figures.joint_zero = 0.01;
  Sensors sensors(model, figures, 0.0005, 2, 1);
  Multibody multibody(model);
  const int n = model.joint_count;
  State state;
  state.q = Eigen::VectorXd::Zero(n);
  state.u = Eigen::VectorXd::Zero(6 + n);
  multibody.set_state(state);
  const DriveReadings drives{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Constant(n, 0.002),
                             Eigen::VectorXd::Zero(n)};
  const FootWrench wrench[GAITD_MAX_FEET];
  sensors.reset(state, multibody.bodies(), drives, wrench);
  state.q.setConstant(0.3);
  state.u.tail(n).setConstant(0.7);
  sensors.sample(state, multibody.bodies(), drives, wrench);
  EXPECT_TRUE(sensors.measured_position().isApproxToConstant(0.312, 1e-12));
  EXPECT_TRUE(sensors.measured_velocity().isApproxToConstant(0.7, 1e-12));
  GaitdSensors shown;
  sensors.read(0, 0, &shown);
  EXPECT_NEAR(shown.joints[0].position, 0.012, 1e-12);
}

TEST(Sensors, StampingFeetShakeTheImu) {
  const GaitdModel model = test::block_model();
  Config config = test::block_config();
  config.sensors.strike_vibration = 30;
  SimbodyPlant ringing(model, config, 0.001);
  SimbodyPlant silent(model, test::block_config(), 0.001);
  double before = 0, after = 0;
  for (Plant* plant : {&ringing, &silent}) plant->place(test::block_state(0, 0, 0.005));
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(test::run(&ringing, 0.001) && test::run(&silent, 0.001));
    const GaitdSensors a = sensors_of(ringing), b = sensors_of(silent);
    double difference = 0;
    for (int k = 0; k < 3; ++k) {
      difference += std::pow(a.imus[0].specific_force[k] - b.imus[0].specific_force[k], 2);
    }
    double& largest = test::truth_of(silent).feet[0].force[2] > 0 || after > 0 ? after : before;
    largest = std::max(largest, std::sqrt(difference));
  }
  EXPECT_EQ(before, 0);
  // 0.31 m/s of two feet, each in a direction of its own.
  EXPECT_GT(after, 2);
  EXPECT_LT(after, 2 * 30 * 0.32);
}

}  // namespace
}  // namespace gaitd::sim
