// SPDX-License-Identifier: Apache-2.0
#include "cli/live/robot_metadata.h"

#include <string>

namespace gaitd::cli {

using nlohmann::json;

daemon::LogMetadata log_metadata_of(const json& robot) {
  daemon::LogMetadata metadata;
  const json log = robot.value("log", json::object());
  for (const auto& [key, value] : log.items()) {
    if (value.is_string()) metadata[key] = value.get<std::string>();
  }
  metadata["robot"] = robot.value("name", "");
  metadata["backend"] = robot.value("backend", "");
  metadata["robot_yaml"] = robot.value("robot", json::object()).dump();  // YAML holds JSON
  metadata["robot_urdf"] = robot.value("urdf", "");
  if (const json world = robot.value("world", json()); !world.is_null()) {
    metadata["world"] = world.dump();
  }
  return metadata;
}

}  // namespace gaitd::cli
