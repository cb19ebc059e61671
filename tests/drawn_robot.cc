// SPDX-License-Identifier: Apache-2.0
// What a simulated robot drew that nobody tells the controller: for tests of what finds it out.
//   drawn_robot LOG    one JSON object: joint → {zero, stiffness, coulomb, viscous, bias}
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "daemon/log/log_reader.h"
#include "daemon/replay/robot_of_log.h"
#include "gaitd/sim/config.h"
#include "gaitd/sim/drive_figures.h"
#include "gaitd/sim/random.h"

int main(int argc, char** argv) {
  using namespace gaitd;  // NOLINT(google-build-using-namespace)
  std::string error;
  const auto log = argc == 2 ? daemon::LogReader::open(argv[1], &error) : nullptr;
  const auto robot = log ? daemon::robot_of_log(*log, nullptr, &error) : std::nullopt;
  if (!robot) {
    std::fprintf(stderr, "%s\n", error.c_str());
    return 1;
  }
  std::vector<std::string> errors;
  const sim::Config config =
      sim::parse_config(log->metadata_value("world").value_or("{}"), robot->model, 0.001, &errors);
  sim::RandomStream zero(config.seed, sim::RandomPurpose::kJointZero);
  nlohmann::json result;
  const sim::DrawnDrives drives = config.drives
                                      ? sim::draw_drives(robot->model, *config.drives, config.seed)
                                      : sim::DrawnDrives{};
  for (int j = 0; j < robot->model.joint_count; ++j) {
    nlohmann::json& joint = result[robot->model.joints[j].name];
    joint["zero"] = config.sensors.joint_zero.sample(&zero);
    if (!config.drives) continue;
    const sim::JointDrive& drive = drives.joints[static_cast<std::size_t>(j)];
    joint["stiffness"] = drive.stiffness;
    joint["bias"] = drive.bias;
    joint["coulomb"] = drive.friction.coulomb;
    joint["viscous"] = drive.friction.viscous + drive.velocity_coupling;
  }
  std::puts(result.dump().c_str());
  return 0;
}
