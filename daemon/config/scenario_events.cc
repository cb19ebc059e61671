// SPDX-License-Identifier: Apache-2.0
// What happens in a scenario: commands and disturbances.
#include <algorithm>
#include <array>
#include <cmath>

#include "daemon/config/command_parse.h"
#include "daemon/config/daemon_config.h"
#include "daemon/config/scenario_sections.h"

namespace gaitd::daemon {
namespace {

constexpr std::size_t kMaxEvents = 10000;
constexpr Bounds kForceBounds = {-1e5, 1e5, "N"};

// A key of a command line in a scenario, and the method that it stands for.
struct Verb {
  std::string key;
  std::string method;
};

std::vector<Verb> all_verbs() {
  std::vector<Verb> verbs;
  for (const std::string& method : command_methods()) verbs.push_back({method, method});
  verbs.push_back({"push", "sim.push"});
  verbs.push_back({"load", "sim.load"});
  verbs.push_back({"swap", "plugin.swap"});
  verbs.push_back({"param", "param.set"});
  return verbs;
}

void add_swap(MapReader map, ScenarioCommand command, std::vector<ScenarioCommand>* out) {
  map.require({"layer", "to"});
  const auto layer = map.choice("layer", kLayerNames);
  const auto variant = map.text("to");
  map.finish();
  command.params = {{"layer", std::string(kLayerNames[layer.value_or(0)])},
                    {"variant", variant.value_or("")}};
  out->push_back(std::move(command));
}

// A scope may be a map of its own, as under `set:`; `scope` is its name with a dot, or empty.
void add_parameters(MapReader map, const std::string& scope, const ScenarioCommand& command,
                    std::vector<ScenarioCommand>* out) {
  for (const Node::Entry& entry : map.entries()) {
    if (entry.value->kind == NodeKind::kMap) {
      add_parameters(map.map(entry.key), scope + entry.key + ".", command, out);
      continue;
    }
    if (!as_number(*entry.value) && !as_boolean(*entry.value)) {
      map.fail(entry.key, "a number, true or false", describe(*entry.value), "write one");
    }
    ScenarioCommand one = command;
    one.params = {{"name", scope + entry.key}, {"value", to_json(*entry.value)}};
    out->push_back(std::move(one));
  }
}

// {at: 1.0, walk: {...}}
void read_command(MapReader map, double duration, const std::vector<Verb>& verbs,
                  std::vector<ScenarioCommand>* out) {
  map.require({"at"});
  ScenarioCommand command;
  command.where = map.where();
  command.at = map.number("at", {0.0, 86400.0, "s"}).value_or(0.0);
  if (command.at > duration) {
    map.fail("at", "a time before the end of the scenario", describe(*map.node("at")),
             "make 'duration' longer or the time smaller");
  }
  int found = 0;
  for (const Verb& verb : verbs) {
    const NodePtr params = map.node(verb.key);
    if (!params) continue;
    ++found;
    command.method = verb.method;
    if (verb.method == "plugin.swap") {
      add_swap(map.map(verb.key), command, out);
    } else if (verb.method == "param.set") {
      add_parameters(map.map(verb.key), "", command, out);
    } else {
      parse_command(verb.method, params, nullptr, map.path_of(verb.key), map.issues());
      command.params = to_json(*params);
      out->push_back(command);
    }
  }
  if (map.valid() && found != 1) {
    map.fail("", "one command beside 'at'", std::to_string(found),
             "write one list item per command");
  }
  map.finish();
}

void read_when(MapReader map, double duration, ScenarioDisturbance* disturbance) {
  constexpr std::array<std::string_view, 2> kPhases = {"transfer", "swing"};
  disturbance->at_step = map.has("step");
  if (map.valid() && map.has("time") == map.has("step")) {
    map.fail("", "either time or step", map.has("time") ? "both" : "neither",
             "write {time: s} or {step: k, phase: swing, fraction: 0.5}");
  }
  if (const auto time = map.number("time", {0.0, 86400.0, "s"})) {
    disturbance->time = *time;
    if (*time > duration) {
      map.fail("time", "a time before the end of the scenario", describe(*map.node("time")),
               "make 'duration' longer or the time smaller");
    }
  }
  disturbance->step = static_cast<int>(map.integer("step", 1, 100000).value_or(0));
  disturbance->phase =
      map.choice("phase", kPhases).value_or(1) == 0 ? GAITD_PHASE_TRANSFER : GAITD_PHASE_SWING;
  disturbance->fraction = map.number("fraction", {0.0, 1.0, ""}).value_or(0.0);
  map.finish();
}

// [x, y, z], or a number: horizontal, in the direction of that angle.
void read_force(MapReader* map, ScenarioDisturbance* disturbance) {
  const NodePtr force = map->node("force");
  const bool number = force && force->kind == NodeKind::kScalar;
  if (!number) map->numbers("force", disturbance->force, kForceBounds);
  if (!number && map->has("direction")) {
    map->fail("direction", "none beside a force of three numbers",
              describe(*map->node("direction")),
              "write the force as one number, in N, or leave the direction out");
    return;
  }
  const double angle = map->number("direction", {-100.0, 100.0, "rad"}).value_or(0.0);
  if (!number) return;
  const double size = map->number("force", kForceBounds).value_or(0.0);
  disturbance->force = {size * std::cos(angle), size * std::sin(angle), 0.0};
}

ScenarioDisturbance read_disturbance(MapReader map, double duration) {
  ScenarioDisturbance disturbance;
  disturbance.where = map.where();
  map.require({"link", "force", "duration", "when"});
  disturbance.link = map.text("link").value_or("");
  map.numbers("point", disturbance.point, {-10.0, 10.0, "m"});
  read_force(&map, &disturbance);
  disturbance.duration = map.number("duration", {1e-4, 60.0, "s"}).value_or(0.0);
  read_when(map.map("when"), duration, &disturbance);
  map.finish();
  return disturbance;
}

}  // namespace

std::vector<ScenarioCommand> read_scenario_commands(MapReader* root, double duration) {
  const std::vector<NodePtr> nodes = root->list("commands", 0, kMaxEvents);
  const std::vector<Verb> verbs = all_verbs();
  std::vector<ScenarioCommand> commands;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::string path = "commands[" + std::to_string(i) + "]";
    read_command(MapReader(nodes[i], path, root->issues()), duration, verbs, &commands);
  }
  std::stable_sort(commands.begin(), commands.end(),
                   [](const ScenarioCommand& a, const ScenarioCommand& b) { return a.at < b.at; });
  return commands;
}

std::vector<ScenarioDisturbance> read_disturbances(MapReader* root, double duration,
                                                   const CommandedSteps& steps) {
  const std::vector<NodePtr> nodes = root->list("disturbances", 0, kMaxEvents);
  const long long swings = steps.advancing + steps.closing;
  std::vector<ScenarioDisturbance> result;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::string path = "disturbances[" + std::to_string(i) + "]";
    result.push_back(read_disturbance(MapReader(nodes[i], path, root->issues()), duration));
    const ScenarioDisturbance& disturbance = result.back();
    if (disturbance.at_step && disturbance.step > swings) {
      root->issues()->add(disturbance.where, path + ".when.step",
                          "at most the last step that is commanded, " + std::to_string(swings),
                          std::to_string(disturbance.step), "lower it or walk further");
    }
  }
  return result;
}

}  // namespace gaitd::daemon
