// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/issues.h"
#include "daemon/config/node.h"
#include "daemon/config/settings.h"
#include "daemon/verdict/expectations.h"
#include "gaitd/abi/plugin.h"
#include "gaitd/abi/types.h"
#include "gaitd/terrain/height_map.h"

namespace gaitd::daemon {

// A command at a time. The methods are those of parse_command, and
//   plugin.swap {layer, variant}   and   param.set {name, value}
// which the daemon outside the control thread carries out.
struct ScenarioCommand {
  double at = 0.0;  // s
  std::string method;
  nlohmann::json params;
  Location where;
};

// A push, at a time or in a phase of a step.
struct ScenarioDisturbance {
  std::string link;
  std::array<double, 3> point{};  // m, link frame
  std::array<double, 3> force{};  // N, W
  double duration = 0.0;          // s
  bool at_step = false;
  double time = 0.0;              // s, unless at_step
  int step = 0;                   // k-th swing, from 1
  int phase = GAITD_PHASE_SWING;  // GAITD_PHASE_TRANSFER: the transfer before that swing
  double fraction = 0.0;          // of the phase, 0..1
  Location where;
};

// One scenario file, schema gaitd.scenario/1, checked.
struct Scenario {
  std::string file;
  std::string name;
  std::string robot;      // a name or the path of a robot.yaml
  double duration = 0.0;  // s, simulated
  std::uint64_t seed = 1;
  GaitdStart start{};    // middle of the feet
  nlohmann::json hoist;  // start.hoist as written; null: it stands
  Location start_where;
  int mode = GAITD_MODE_STAND;
  // Of the simulator's configuration, as written there.
  nlohmann::json terrain;
  std::shared_ptr<const terrain::HeightMap> height_map;  // of the terrain; null: none
  nlohmann::json sensors;
  nlohmann::json actuators;
  nlohmann::json model_error;
  nlohmann::json perception;              // null: footsteps are planned on the true terrain
  std::vector<ScenarioCommand> commands;  // by time; equal times in the order of the file
  std::vector<ScenarioDisturbance> disturbances;
  Expectations expect;
  nlohmann::json expect_section;  // as written in the file, for the log; {} if there is none

  // {"start": {x, y, z, yaw}, "seed", "terrain", "sensors", "actuators", "model_error"}
  nlohmann::json simulator_config() const;
};

// Reads a scenario and puts its `set:` and `robot:` into the settings. Values that the command line
// set under a key of the scenario (seed, duration, start.x, mode, terrain.friction, sensors.noise,
// actuators.model, model_error.mass_scale.utorso, disturbances.0.force, commands.0.walk.length)
// take the place of those of the file. Nothing when there is any error; warnings too go to
// `issues`.
std::optional<Scenario> load_scenario(const std::string& file, Settings* settings, Issues* issues);
std::optional<Scenario> read_scenario(const NodePtr& root, const std::string& file,
                                      Settings* settings, Issues* issues);

// The `expect` section as a log holds it (Scenario::expect_section as text). Nothing if it makes no
// sense.
std::optional<Expectations> read_logged_expectations(const std::string& text);

// What could only be checked with the robot: the links that commands, disturbances and model errors
// name, and whether there is room at the start.
void check_scenario(const Scenario& scenario, const GaitdModel& model, Issues* issues);

}  // namespace gaitd::daemon
