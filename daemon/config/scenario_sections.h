// SPDX-License-Identifier: Apache-2.0
// The sections of a scenario file, one function each. Errors go to the issues of the reader.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "daemon/config/scenario.h"
#include "daemon/config/yaml_reader.h"

namespace gaitd::daemon {

nlohmann::json read_terrain(MapReader map);
nlohmann::json read_sensors(MapReader map);
nlohmann::json read_actuators(MapReader map);
nlohmann::json read_model_error(MapReader map);

std::vector<ScenarioCommand> read_scenario_commands(MapReader* root, double duration);
std::vector<ScenarioDisturbance> read_disturbances(MapReader* root, double duration,
                                                   const std::vector<ScenarioCommand>& commands);
Expectations read_expectations(MapReader map);

}  // namespace gaitd::daemon
