// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "atlas_model.h"
#include "gaitd/sim/plant.h"
#include "simbody_plant.h"

namespace gaitd::sim {
namespace {

using test::SimbodyPlant;

double cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

GaitdTruth truth_of(const Plant& plant) {
  GaitdTruth truth;
  plant.read(&truth);
  return truth;
}

TEST(Standing, AtlasHeldByStiffJointsStandsFiveSecondsWithoutDrift) {
  const GaitdModel model = test::atlas_model();
  SimbodyPlant plant(model, test::flat_config(model), 0.001);
  const GaitdJointCommands commands = test::hold_posture(model);
  for (int i = 0; i < 5000; ++i) ASSERT_TRUE(plant.advance(commands));
  const GaitdTruth before = truth_of(plant);
  const double start = cpu_seconds();
  for (int i = 0; i < 5000; ++i) ASSERT_TRUE(plant.advance(commands));
  std::printf("real-time factor of the plant, standing: %.1f\n", 5 / (cpu_seconds() - start));
  const GaitdTruth after = truth_of(plant);
  double load = 0;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    EXPECT_LT(after.feet[side].penetration, 1e-3);
    EXPECT_LT(after.feet[side].slip, 1e-3);
    EXPECT_EQ(after.feet[side].side_force, 0);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(after.feet[side].position[k], before.feet[side].position[k], 1e-5);
    }
    load += after.feet[side].force[2];
  }
  EXPECT_NEAR(load, model.total_mass * model.gravity, 0.1);
  EXPECT_NEAR(after.com[0], before.com[0], 1e-4);
  EXPECT_EQ(after.body_contact, 0);
}

TEST(Standing, StartIsAtThePlaceOfTheConfigurationOnItsSoles) {
  const GaitdModel model = test::atlas_model();
  Config config = test::flat_config(model);
  config.terrain.ground_z = 0.4;
  config.start = {1.0, -2.0, 0.7, std::nullopt};
  SimbodyPlant plant(model, config, 0.001);
  GaitdTruth truth = truth_of(plant);
  const double* l = truth.feet[0].position;
  const double* r = truth.feet[1].position;
  EXPECT_NEAR(0.5 * (l[0] + r[0]), 1.0, 1e-9);
  EXPECT_NEAR(0.5 * (l[1] + r[1]), -2.0, 1e-9);
  EXPECT_NEAR(l[2], 0.4, 5e-4);
  EXPECT_NEAR(std::atan2(r[0] - l[0], l[1] - r[1]), 0.7, 1e-9);
  EXPECT_NEAR(2 * std::atan2(truth.pelvis_orientation[2], truth.pelvis_orientation[3]), 0.7, 1e-9);
  EXPECT_NEAR(truth.feet[0].force[2] + truth.feet[1].force[2], model.total_mass * model.gravity,
              1e-6);
}

TEST(Standing, StartInsideTheTerrainIsRefused) {
  const GaitdModel model = test::atlas_model();
  Config config = test::flat_config(model);
  config.start.z = -0.05;
  try {
    SimbodyPlant plant(model, config, 0.001);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()).rfind("start: expected ", 0), 0u) << error.what();
  }
}

TEST(Standing, FiveCentimetreDropIsSurvivedAndSettles) {
  const GaitdModel model = test::atlas_model();
  SimbodyPlant plant(model, test::flat_config(model), 0.001);
  State state = plant.state();
  state.p_WB.z() += 0.05;
  plant.place(state);
  const GaitdJointCommands commands = test::hold_posture(model, 60);
  double deepest = 0, peak = 0;
  for (int i = 0; i < 3000; ++i) {
    ASSERT_TRUE(plant.advance(commands));
    const GaitdTruth truth = truth_of(plant);
    for (const GaitdFootTruth& foot : truth.feet) {
      deepest = std::max(deepest, foot.penetration);
      peak = std::max(peak, foot.force[2]);
    }
  }
  std::printf("5 cm drop: deepest %.2f mm, peak force per foot %.0f N\n", 1e3 * deepest, peak);
  EXPECT_LT(deepest, 5e-3);
  EXPECT_LT(truth_of(plant).feet[0].penetration, 1e-3);
  EXPECT_GT(truth_of(plant).pelvis_position[2], 0.8);
}

// J, in the springs of contacts (as of the beginning of the last step) and stops.
double elastic_energy(const SimbodyPlant& plant) {
  double energy = 0;
  for (const Contact& c : plant.simbody().contacts().contacts()) {
    energy += 0.5 * c.law.stiffness * (c.depth * c.depth + c.deflection.squaredNorm());
  }
  for (int j = 0; j < plant.model().joint_count; ++j) {
    const GaitdJoint& joint = plant.model().joints[j];
    const double q = plant.state().q[j];
    const double beyond = std::max({0.0, q - joint.position_max, joint.position_min - q});
    energy += 0.5 * joint.effort_limit / 0.01 * beyond * beyond;
  }
  return energy;
}

TEST(Falling, LimpRobotLosesEnergyStaysWithinItsStopsAndLiesOnTheGround) {
  const GaitdModel model = test::atlas_model();
  SimbodyPlant plant(model, test::flat_config(model), 0.001);
  const GaitdJointCommands commands = test::limp(model);
  GaitdDisturbance push{};
  push.force[0] = 100;
  push.duration = 0.1;
  push.body = model.chest_body;
  ASSERT_TRUE(plant.disturb(push));
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(plant.advance(commands));
  const auto total = [&] { return plant.simbody().energy() + elastic_energy(plant); };
  const double initial = total();
  double lowest = initial, overshoot = 0, gain = 0;
  const double start = cpu_seconds();
  for (int i = 0; i < 6000; ++i) {
    ASSERT_TRUE(plant.advance(commands));
    gain = std::max(gain, total() - lowest);
    lowest = std::min(lowest, total());
    for (int j = 0; j < model.joint_count; ++j) {
      const double q = plant.state().q[j];
      overshoot =
          std::max({overshoot, q - model.joints[j].position_max, model.joints[j].position_min - q});
    }
  }
  std::printf(
      "real-time factor of the plant, falling and lying: %.1f; energy gain %.2f J of %.0f, "
      "overshoot of stops %.3f rad\n",
      6 / (cpu_seconds() - start), gain, initial, overshoot);
  EXPECT_LT(gain, 0.01 * initial);
  EXPECT_LT(overshoot, 0.1);
  const GaitdTruth truth = truth_of(plant);
  EXPECT_EQ(truth.body_contact, 1);
  EXPECT_LT(truth.com[2], 0.6);
  EXPECT_GT(truth.com[2], 0.05);
  EXPECT_LT(std::hypot(truth.com_velocity[0], truth.com_velocity[1], truth.com_velocity[2]), 0.1);
  for (int i = 0; i < model.body_count; ++i) {
    EXPECT_GT(plant.simbody().multibody().body(i).p_WB.z(), -0.15) << model.bodies[i].name;
  }
}

TEST(JointStop, HoldsTheFullTorqueOfItsDrive) {
  const GaitdModel model = test::atlas_model();
  Config config = test::flat_config(model);
  SimbodyPlant plant(model, config, 0.001);
  GaitdJointCommands commands = test::hold_posture(model);
  const int elbow = test::joint_index(model, "l_arm_ely");
  commands.joints[elbow].stiffness = 0;
  commands.joints[elbow].damping = 0;
  for (const double sign : {1.0, -1.0}) {
    plant.reset();
    commands.joints[elbow].torque = sign * model.joints[elbow].effort_limit;
    for (int i = 0; i < 1500; ++i) ASSERT_TRUE(plant.advance(commands));
    const double q = plant.state().q[elbow];
    const double limit =
        sign > 0 ? model.joints[elbow].position_max : model.joints[elbow].position_min;
    EXPECT_NEAR(q, limit + sign * 0.01, 0.01);
    EXPECT_NEAR(plant.state().u[6 + elbow], 0, 0.02);
  }
}

TEST(ModelError, SimulatedRobotDiffersAsTold) {
  const GaitdModel model = test::atlas_model();
  Config config = test::flat_config(model);
  const int chest = model.chest_body;
  config.body_errors[static_cast<size_t>(chest)].mass_scale = 1.1;
  config.body_errors[static_cast<size_t>(chest)].com_offset.x() = 0.05;
  SimbodyPlant plain(model, test::flat_config(model), 0.001);
  SimbodyPlant wrong(model, config, 0.001);
  const double extra = 0.1 * model.bodies[chest].mass;
  EXPECT_NEAR(wrong.model().total_mass, model.total_mass + extra, 1e-9);
  EXPECT_NEAR(wrong.model().bodies[chest].inertia[0], 1.1 * model.bodies[chest].inertia[0], 1e-9);
  EXPECT_GT(truth_of(wrong).com[0], truth_of(plain).com[0] + 0.02);
}

// Random torques under noisy sensors and drives, with a push and a fall in it.
std::vector<char> eventful_run() {
  const GaitdModel model = test::atlas_model();
  Config config = test::flat_config(model);
  config.sensors = SensorFigures::nominal();
  config.actuators = ActuatorFigures::nominal();
  config.seed = 7;
  BoxConfig box;
  box.center = Eigen::Vector3d(0.2, 0, -0.09);
  box.size = Eigen::Vector3d(0.3, 1, 0.2);
  config.terrain.boxes.push_back(box);
  SimbodyPlant plant(model, config, 0.001);
  GaitdDisturbance push{};
  push.force[0] = 600;
  push.duration = 0.1;
  push.body = model.chest_body;
  plant.disturb(push);
  const GaitdJointCommands commands = test::hold_posture(model);
  std::vector<char> bytes;
  for (int i = 0; i < 1500; ++i) {
    plant.advance(commands);
    if (i % 50 != 49) continue;
    GaitdSensors sensors;
    plant.read(&sensors);
    const GaitdTruth truth = truth_of(plant);
    const size_t at = bytes.size();
    bytes.resize(at + sizeof(sensors) + sizeof(truth));
    std::memcpy(bytes.data() + at, &sensors, sizeof(sensors));
    std::memcpy(bytes.data() + at + sizeof(sensors), &truth, sizeof(truth));
  }
  return bytes;
}

TEST(Determinism, RunsAreBitIdenticalAlsoBesideOtherThreads) {
  const std::vector<char> alone = eventful_run();
  std::vector<char> beside[2];
  std::thread other([&] { beside[1] = eventful_run(); });
  beside[0] = eventful_run();
  other.join();
  EXPECT_TRUE(alone == beside[0]);
  EXPECT_TRUE(alone == beside[1]);
}

TEST(Determinism, ResetStartsTheSameRunAgain) {
  const GaitdModel model = test::atlas_model();
  Config config = test::flat_config(model);
  config.sensors = SensorFigures::nominal();
  config.actuators = ActuatorFigures::nominal();
  SimbodyPlant plant(model, config, 0.001);
  const GaitdJointCommands commands = test::hold_posture(model);
  GaitdSensors first, second;
  for (int i = 0; i < 200; ++i) plant.advance(commands);
  plant.read(&first);
  plant.reset();
  for (int i = 0; i < 200; ++i) plant.advance(commands);
  plant.read(&second);
  EXPECT_EQ(std::memcmp(&first, &second, sizeof(first)), 0);
}

TEST(Stability, HighGainsOnLightLinksAtAnyStepStayCalm) {
  const GaitdModel model = test::atlas_model();
  for (const double step : {0.00025, 0.0005, 0.001}) {
    Config config = test::flat_config(model);
    config.time_step = step;
    SimbodyPlant plant(model, config, 0.001);
    const GaitdJointCommands commands = test::hold_posture(model, 500);
    for (int i = 0; i < 1000; ++i) ASSERT_TRUE(plant.advance(commands));
    EXPECT_LT(plant.state().u.cwiseAbs().maxCoeff(), 1e-2) << step;
  }
}

}  // namespace
}  // namespace gaitd::sim
