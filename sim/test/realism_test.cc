// SPDX-License-Identifier: Apache-2.0
// What holds for all errors of sensors and drives together: they come from the seed, each kind on
// its own, and without any the robot is the ideal one.
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "atlas_model.h"
#include "gaitd/sim/plant.h"
#include "gaitd/sim/sensor_figure_keys.h"
#include "simbody_plant.h"

namespace gaitd::sim {
namespace {

using test::SimbodyPlant;

struct Moment {
  GaitdSensors sensors;
  GaitdTruth truth;
};

// `ticks` of a robot that holds its posture, with a push.
std::vector<Moment> run(Plant* plant, const GaitdJointCommands& commands, int ticks = 300) {
  std::vector<Moment> moments(static_cast<size_t>(ticks));
  GaitdDisturbance push{};
  push.body = plant->model().chest_body;
  push.force[0] = 300;
  push.duration = 0.05;
  plant->disturb(push);
  for (Moment& moment : moments) {
    EXPECT_TRUE(plant->advance(commands));
    plant->read(&moment.sensors);
    plant->read(&moment.truth);
  }
  return moments;
}

template <class T>
bool same(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

Config realistic(const GaitdModel& model, const char* drives, uint64_t seed = 3) {
  Config config = test::flat_config(model);
  config.seed = seed;
  config.sensors = SensorFigures::rough();
  config.drives.emplace();
  EXPECT_TRUE(find_drive_class(drives, &*config.drives));
  return config;
}

class EveryClass : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Realism, EveryClass, ::testing::ValuesIn(kDriveClasses));

TEST_P(EveryClass, TheSameSeedGivesTheSameBitsAndAnotherOneOthers) {
  const GaitdModel model = test::atlas_model();
  const GaitdJointCommands commands = test::hold_posture(model, 4);
  SimbodyPlant plant(model, realistic(model, GetParam()), 0.001);
  const auto first = run(&plant, commands);
  plant.reset();
  const auto again = run(&plant, commands);
  SimbodyPlant other(model, realistic(model, GetParam(), 4), 0.001);
  const auto different = run(&other, commands);
  for (size_t i = 0; i < first.size(); ++i) {
    ASSERT_TRUE(same(first[i].sensors, again[i].sensors)) << i;
    ASSERT_TRUE(same(first[i].truth, again[i].truth)) << i;
  }
  EXPECT_FALSE(same(first.back().truth, different.back().truth));
}

TEST_P(EveryClass, AnotherSensorChangesNothingOfTheDrives) {
  GaitdModel model = test::atlas_model();
  const GaitdJointCommands commands = test::hold_posture(model, 4);
  SimbodyPlant one(model, realistic(model, GetParam()), 0.001);
  const auto alone = run(&one, commands);
  model.imu_count = 2;
  model.imus[1] = model.imus[0];
  SimbodyPlant two(model, realistic(model, GetParam()), 0.001);
  const auto together = run(&two, commands);
  for (size_t i = 0; i < alone.size(); ++i) {
    ASSERT_TRUE(same(alone[i].truth, together[i].truth)) << i;
  }
}

// All names of figures that a class has, as a scenario would set them to nothing.
nlohmann::json all_sensors_off() {
  nlohmann::json map = {{"class", "rough"}, {"stamp", "measurement"}};
  for (const SensorFigureKey& key : kSensorFigureKeys) map[key.name] = key.minimum > 0 ? 1 : 0;
  map["joint_zero"] = 0;
  return map;
}

nlohmann::json all_drives_off(const char* name) {
  nlohmann::json map = {{"class", name}, {"elasticity", "measured"}};
  for (const char* key :
       {"coulomb_scale", "viscous_scale",     "load_share",        "bandwidth",
        "supply_torque", "command_delay",     "command_jitter",    "command_jitter_tail",
        "lost_commands", "torque_noise",      "scale_error",       "bias",
        "dead_band",     "velocity_coupling", "cogging",           "derating_end",
        "orifice_speed", "stiffness",         "hip_yaw_stiffness", "hip_roll_stiffness",
        "backlash",      "armature_scale"}) {
    map[key] = 0;
  }
  return map;
}

TEST_P(EveryClass, WithAllFiguresOffTheRobotIsTheIdealOneToTheLastBit) {
  const GaitdModel model = test::atlas_model();
  const nlohmann::json text = {{"terrain", {{"ground_z", 0}}},
                               {"sensors", {{"noise", all_sensors_off()}}},
                               {"actuators", {{"model", all_drives_off(GetParam())}}}};
  std::vector<std::string> errors;
  const Config off = parse_config(text.dump(), model, 0.001, &errors);
  for (const std::string& error : errors) ADD_FAILURE() << error;
  // Without gains: those of real drives act on the encoder, so at the beginning of a step.
  GaitdJointCommands commands = test::limp(model);
  for (int j = 0; j < model.joint_count; ++j) {
    commands.joints[j].mode = GAITD_JOINT_MODE_TORQUE;
    commands.joints[j].torque = 0.02 * model.joints[j].effort_limit * (j % 3 - 1);
  }
  SimbodyPlant plain(model, test::flat_config(model), 0.001);
  SimbodyPlant without(model, off, 0.001);
  const auto ideal = run(&plain, commands);
  const auto real = run(&without, commands);
  for (size_t i = 0; i < ideal.size(); ++i) {
    ASSERT_TRUE(same(ideal[i].truth, real[i].truth)) << i;
    ASSERT_TRUE(same(ideal[i].sensors, real[i].sensors)) << i;
  }
}

}  // namespace
}  // namespace gaitd::sim
