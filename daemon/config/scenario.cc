// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/scenario.h"

#include <algorithm>
#include <filesystem>

#include "daemon/config/command_parse.h"
#include "daemon/config/names.h"
#include "daemon/config/scenario_sections.h"
#include "daemon/config/yaml_reader.h"

namespace gaitd::daemon {
namespace {

// What the command line may replace. Of what is expected only which drives the bounds are for.
constexpr std::string_view kBoundsKey = "expect.bounds";
constexpr std::array<std::string_view, 11> kOverridable = {
    "duration",  "seed",        "start",        "mode",     "terrain",   "sensors",
    "actuators", "model_error", "disturbances", "commands", "perception"};

// Of a list only single keys of what is there: disturbances.0.force, commands.0.walk.length.
bool is_there(const NodePtr& root, const std::string& key, const Location& where, Issues* issues) {
  const std::string list_key = key.substr(0, key.find('.'));
  if (list_key != "disturbances" && list_key != "commands") return true;
  const Node::Entry* entry = root->find(list_key);
  const NodePtr list = entry != nullptr ? entry->value : nullptr;
  const std::string rest = key.substr(std::min(key.size(), list_key.size() + 1));
  if (item_index(list, std::string_view(rest).substr(0, rest.find('.')))) return true;
  const std::size_t count = list ? list->items.size() : 0;
  issues->add(where, key,
              "one of the " + std::to_string(count) + " " + list_key + " of the scenario",
              rest.empty() ? "all of them" : "'" + rest + "'",
              "count from 0, for example " + list_key +
                  (list_key == "commands" ? ".0.walk.length=0.3" : ".0.force=[100, 0, 0]"));
  return false;
}

NodePtr with_overrides(NodePtr root, Settings* settings, Issues* issues) {
  for (const Settings::Entry& entry : settings->from(SettingSource::kCommandLine)) {
    const std::string_view first = std::string_view(entry.key).substr(0, entry.key.find('.'));
    const bool known =
        std::find(kOverridable.begin(), kOverridable.end(), first) != kOverridable.end();
    if (!known && entry.key != kBoundsKey) continue;
    settings->declare(entry.key);
    if (!is_there(root, entry.key, entry.value->where, issues)) continue;
    root = with_value(root, entry.key, entry.value);
  }
  return root;
}

// Logs are called by it.
std::string read_name(MapReader* root) {
  std::string name = root->text("name").value_or("");
  if (!name.empty() && !is_file_name(name)) {
    root->fail("name",
               "a name for files: letters, digits, '.', '_' and '-', at most " +
                   std::to_string(kMaxFileName) + " of them, the first no '.'",
               describe(*root->node("name")), "call it for example flat-0.35");
  }
  return name;
}

// Without a height the robot starts on the height map where there is one, else on the ground.
GaitdStart read_start(MapReader map, const Scenario& scenario, const Location& where,
                      nlohmann::json* hoist) {
  const nlohmann::json& terrain = scenario.terrain;
  GaitdStart start{};
  start.position[0] = map.number("x", kPositionBounds).value_or(0.0);
  start.position[1] = map.number("y", kPositionBounds).value_or(0.0);
  std::optional<double> ground;
  if (terrain.contains("ground_z")) ground = terrain["ground_z"].get<double>();
  if (scenario.height_map) {
    if (const auto s = scenario.height_map->surface({start.position[0], start.position[1]})) {
      ground = s->height;
    }
  }
  start.position[2] = map.number("z", kPositionBounds).value_or(ground.value_or(0.0));
  if (!map.has("z") && !ground) {
    map.issues()->add(map.valid() ? map.where() : where, "start.z",
                      scenario.height_map
                          ? "the height of the soles, as neither terrain.height_map nor "
                            "terrain.ground_z has one there"
                          : "the height of the soles, as there is no terrain.ground_z",
                      "nothing", "add it");
  }
  start.yaw = map.number("yaw", {-100.0, 100.0, "rad"}).value_or(0.0);
  if (map.has("hoist")) {
    MapReader hung = map.map("hoist");
    *hoist = {{"height", hung.number("height", {0.02, 0.2, "m"}).value_or(0.1)}};
    hung.finish();
  }
  map.finish();
  return start;
}

// A path is meant from the folder of the scenario, where there is such a file.
std::string robot_from(const std::string& scenario_file, const std::string& robot) {
  const std::filesystem::path beside = std::filesystem::path(scenario_file).parent_path() / robot;
  std::error_code error;
  if (robot.ends_with(".yaml") && std::filesystem::is_regular_file(beside, error)) {
    return beside.lexically_normal().string();
  }
  return robot;
}

void check_link(const std::string& link, const GaitdModel& model, const Location& where,
                const std::string& path, Issues* issues) {
  if (body_index(model, link) >= 0) return;
  issues->add(where, path, "a link of the robot that moves", link,
              suggestion(link, body_names(model)));
}

void check_sensor(const std::string& sensor, const GaitdModel& model, const std::string& path,
                  const Location& where, Issues* issues) {
  std::vector<std::string> known = {"imu", "left_foot", "right_foot"};
  for (int i = 0; i < model.joint_count; ++i) known.emplace_back(model.joints[i].name);
  if (std::find(known.begin(), known.end(), sensor) != known.end()) return;
  issues->add(where, path, "imu, left_foot, right_foot or a joint", sensor,
              suggestion(sensor, known));
}

}  // namespace

nlohmann::json Scenario::simulator_config() const {
  nlohmann::json place = {{"x", start.position[0]},
                          {"y", start.position[1]},
                          {"z", start.position[2]},
                          {"yaw", start.yaw}};
  if (!hoist.is_null()) place["hoist"] = hoist;
  return {{"start", place},     {"seed", seed},           {"terrain", terrain},
          {"sensors", sensors}, {"actuators", actuators}, {"model_error", model_error}};
}

std::optional<Scenario> load_scenario(const std::string& file, Settings* settings, Issues* issues) {
  Issues found;
  const NodePtr root = load_yaml_file(file, &found);
  std::optional<Scenario> scenario;
  if (root) scenario = read_scenario(root, file, settings, &found);
  issues->append(found);
  return found.ok() ? scenario : std::nullopt;
}

std::optional<Scenario> read_scenario(const NodePtr& document, const std::string& file,
                                      Settings* settings, Issues* issues) {
  Issues found;
  NodePtr overlaid = document;
  if (document->kind == NodeKind::kMap) overlaid = with_overrides(document, settings, &found);
  MapReader root(overlaid, "", &found);
  root.require({"schema", "name", "robot", "duration"});
  root.schema("gaitd.scenario/1");
  Scenario scenario;
  scenario.file = file;
  scenario.name = read_name(&root);
  scenario.robot = robot_from(file, root.text("robot").value_or(""));
  scenario.duration = root.number("duration", {0.001, 86400.0, "s"}).value_or(86400.0);
  scenario.seed = static_cast<std::uint64_t>(root.integer("seed", 0, 4294967295).value_or(1));
  scenario.mode = root.choice("mode", kModeNames).value_or(GAITD_MODE_STAND);
  scenario.terrain = read_terrain(root.map("terrain"), file, &scenario.height_map);
  scenario.start = read_start(root.map("start"), scenario, root.where(), &scenario.hoist);
  scenario.start_where = root.where(root.has("start") ? "start" : "");
  scenario.sensors = read_sensors(root.map("sensors"));
  scenario.actuators = read_actuators(root.map("actuators"));
  scenario.model_error = read_model_error(root.map("model_error"));
  scenario.perception = read_perception(root.map("perception"));
  scenario.commands = read_scenario_commands(&root, scenario.duration);
  const CommandedSteps steps =
      check_commands(scenario.commands, scenario.mode, !scenario.hoist.is_null(), &found);
  scenario.disturbances = read_disturbances(&root, scenario.duration, steps);
  MapReader expect = root.map("expect");
  scenario.expect = read_expectations(expect);
  check_expectations(scenario.expect, steps, scenario.duration, &expect);
  const NodePtr section = root.node("expect");
  scenario.expect_section = section ? to_json(*section) : nlohmann::json::object();
  if (const NodePtr set = root.node("set")) {
    MapReader map(set, "set", &found);
    if (map.valid()) settings->set_tree(SettingSource::kScenario, *set, &found);
  }
  if (const NodePtr robot = root.node("robot"); robot && !scenario.robot.empty()) {
    settings->set(SettingSource::kScenario, "robot", make_scalar(scenario.robot, robot->where));
  }
  root.finish();
  issues->append(found);
  if (!found.ok()) return std::nullopt;
  return scenario;
}

void check_scenario(const Scenario& scenario, const GaitdModel& model, Issues* issues) {
  check_start(scenario, model, issues);
  for (const ScenarioCommand& command : scenario.commands) {
    const bool names_links = command.method.starts_with("sim.") ||
                             command.method.starts_with("payload.") ||
                             command.method == "joint.test";
    if (!names_links) continue;
    const std::string path = command.method == "sim.push"   ? "push"
                             : command.method == "sim.load" ? "load"
                                                            : command.method;
    parse_command(command.method, from_json(command.params, command.where), &model, path, issues);
  }
  if (scenario.perception.contains("link")) {
    check_link(scenario.perception["link"], model, {scenario.file, 0}, "perception.link", issues);
  }
  for (const ScenarioDisturbance& disturbance : scenario.disturbances) {
    check_link(disturbance.link, model, disturbance.where, "disturbances.link", issues);
  }
  const nlohmann::json faults = scenario.sensors.value("faults", nlohmann::json::array());
  for (std::size_t i = 0; i < faults.size(); ++i) {
    check_sensor(faults[i].value("sensor", ""), model,
                 "sensors.faults[" + std::to_string(i) + "].sensor", {scenario.file, 0}, issues);
  }
  for (const auto& [section, links] : scenario.model_error.items()) {
    if (!links.is_object()) continue;
    for (const auto& [link, value] : links.items()) {
      check_link(link, model, {scenario.file, 0}, "model_error." + section, issues);
    }
  }
}

}  // namespace gaitd::daemon
