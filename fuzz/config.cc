// SPDX-License-Identifier: Apache-2.0
// YAML that people write: gaitd.yaml, robot.yaml and scenarios, told apart by their schema.
#include <cstdint>
#include <string>
#include <string_view>

#include "daemon/config/daemon_config.h"
#include "daemon/config/node.h"
#include "daemon/config/robot.h"
#include "daemon/config/scenario.h"
#include "fuzz/require.h"
#include "gaitd/dynamics/model_check.h"
#include "gaitd/dynamics/urdf.h"

namespace gaitd::daemon {
namespace {

constexpr char kRobots[] = GAITD_SOURCE_DIR "/robots/atlas/";

const dynamics::UrdfResult& atlas_urdf() {
  static const auto* result = new dynamics::UrdfResult(
      dynamics::load_urdf(std::string(kRobots) + "atlas.urdf", {"pelvis"}));
  fuzz::require(result->ok(), "the URDF of Atlas is read");
  return *result;
}

const Robot& atlas() {
  static const auto* robot = [] {
    Settings settings;
    Issues issues;
    auto read =
        load_robot(std::string(kRobots) + "robot.yaml", Profile::kSimulation, &settings, &issues);
    fuzz::require(read.has_value(), "Atlas is read");
    return new Robot(*read);
  }();
  return *robot;
}

void read_robot_document(const NodePtr& document, Settings* settings, Issues* issues) {
  const auto robot = read_robot(
      document, std::string(kRobots) + "robot.yaml", Profile::kHardware,
      [](const std::string&, const dynamics::UrdfOptions&) { return atlas_urdf(); }, settings,
      issues);
  if (robot) fuzz::require(dynamics::check_model(robot->model).empty(), "the model is physical");
}

void read_scenario_document(const NodePtr& document, Settings* settings, Issues* issues) {
  const auto scenario = read_scenario(document, "fuzz.yaml", settings, issues);
  if (!scenario) return;
  check_scenario(*scenario, atlas().model, issues);
  fuzz::require(!scenario->simulator_config().dump().empty(), "the world is JSON");
}

void read_config_document(const NodePtr& document, Settings* settings, Issues* issues) {
  settings->set_tree(SettingSource::kConfig, *document, issues);
  const DaemonConfig config = read_daemon_config(settings, issues);
  fuzz::require(config.period >= 0.0002 && config.period <= 0.02, "the period is in its range");
}

void read(std::string_view text) {
  Settings settings;
  Issues issues;
  const NodePtr document = parse_yaml(text, "fuzz.yaml", &issues);
  if (!document) {
    fuzz::require(!issues.ok(), "what is not read has an error");
    return;
  }
  const Node::Entry* schema = document->find("schema");
  const std::string& name = schema ? schema->value->text : "";
  if (name.starts_with("gaitd.robot")) {
    read_robot_document(document, &settings, &issues);
  } else if (name.starts_with("gaitd.scenario")) {
    read_scenario_document(document, &settings, &issues);
  } else {
    read_config_document(document, &settings, &issues);
  }
  settings.report_unknown(&issues);
  fuzz::require(issues.ok() == issues.error_text().empty(), "every error has a text");
  for (const Settings::Entry& entry : settings.effective()) to_json(*entry.value);
}

}  // namespace
}  // namespace gaitd::daemon

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  gaitd::daemon::read({reinterpret_cast<const char*>(data), size});
  return 0;
}
