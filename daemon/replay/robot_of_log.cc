// SPDX-License-Identifier: Apache-2.0
#include "daemon/replay/robot_of_log.h"

#include <nlohmann/json.hpp>

#include "daemon/config/node.h"
#include "gaitd/dynamics/urdf.h"

namespace gaitd::daemon {

std::optional<Robot> robot_of_log(const LogReader& log, Settings* settings, std::string* error) {
  const auto replay =
      nlohmann::json::parse(log.metadata_value("replay").value_or("null"), nullptr, false);
  const auto yaml = log.metadata_value("robot_yaml");
  const auto urdf = log.metadata_value("robot_urdf");
  if (!replay.is_object() || !yaml || !urdf) {
    *error = "it does not hold the robot; only logs of this version of gaitd on are replayed";
    return std::nullopt;
  }
  Issues issues;
  Settings unused;
  const std::string file = replay.value("robot_file", "robot.yaml");
  const auto load = [&urdf](const std::string& path, const dynamics::UrdfOptions& options) {
    return dynamics::load_urdf_text(*urdf, path, options);
  };
  const Profile profile =
      replay.value("hardware", false) ? Profile::kHardware : Profile::kSimulation;
  auto robot = read_robot(parse_yaml(*yaml, file, &issues), file, profile, load,
                          settings != nullptr ? settings : &unused, &issues);
  const auto text = log.metadata_value("robot_calibration");
  if (robot && text) {
    const auto calibration =
        read_calibration(parse_yaml(*text, file, &issues), robot->model, &issues);
    if (calibration) robot->calibration = *calibration;
    if (!calibration) robot.reset();
  }
  if (!robot) *error = "its robot cannot be read: " + issues.error_text();
  return robot;
}

}  // namespace gaitd::daemon
