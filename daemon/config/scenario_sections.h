// SPDX-License-Identifier: Apache-2.0
// The sections of a scenario file, one function each. Errors go to the issues of the reader.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "daemon/config/scenario.h"
#include "daemon/config/yaml_reader.h"

namespace gaitd::daemon {

// A height map is read too, its file being meant from the folder of the scenario.
nlohmann::json read_terrain(MapReader map, const std::string& scenario_file,
                            std::shared_ptr<const terrain::HeightMap>* height_map);
nlohmann::json read_sensors(MapReader map);
nlohmann::json read_actuators(MapReader map);
nlohmann::json read_model_error(MapReader map);
// Null: there is none.
nlohmann::json read_perception(MapReader map);

std::vector<ScenarioCommand> read_scenario_commands(MapReader* root, double duration);
// How many swings the commands ask for at most.
struct CommandedSteps {
  long long advancing = 0;
  long long closing = 0;
};
// Reports the commands that will be refused whatever happens: in mode stand, not armed, on the
// wrong foot. They must be in the order of time.
CommandedSteps check_commands(const std::vector<ScenarioCommand>& commands, int mode, bool hangs,
                              Issues* issues);

std::vector<ScenarioDisturbance> read_disturbances(MapReader* root, double duration,
                                                   const CommandedSteps& steps);
Expectations read_expectations(MapReader map);
// Reports what the commanded steps can never fulfil.
void check_expectations(const Expectations& expect, const CommandedSteps& steps, double duration,
                        MapReader* map);
// Reports a start inside a box, the ground or the height map.
void check_start(const Scenario& scenario, const GaitdModel& model, Issues* issues);

}  // namespace gaitd::daemon
