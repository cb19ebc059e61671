// SPDX-License-Identifier: Apache-2.0
#include "cli/completion_values.h"

#include <set>

#include "daemon/config/command_parse.h"
#include "daemon/config/daemon_config.h"
#include "daemon/config/paths.h"
#include "daemon/host/layers.h"
#include "daemon/parameters/reference.h"

namespace gaitd::cli {
namespace {

using Names = std::vector<std::string>;

const daemon::PluginDirectory& plugins() {
  static const daemon::PluginDirectory kInstalled(daemon::Paths::detect().plugin_folders());
  return kInstalled;
}

// Keys of a scenario that --set changes most; docs/scenarios.md has all.
constexpr std::string_view kScenarioKeys[] = {"seed", "duration", "mode", "actuators.model",
                                              "sensors.noise"};

template <typename Add>
void for_each_robot(const Add& add) {
  const daemon::Paths paths = daemon::Paths::detect();
  for (const std::string& name : paths.robots()) {
    daemon::Settings settings;
    daemon::Issues issues;
    const auto file = paths.robot(name);
    const auto robot =
        daemon::load_robot(file->string(), daemon::Profile::kSimulation, &settings, &issues);
    if (robot) add(robot->model);
  }
}

}  // namespace

Names backend_names() { return plugins().variants(GAITD_LAYER_BACKEND); }

Names simulation_names() {
  Names names;
  for (const daemon::PluginEntry& plugin : plugins().list()) {
    const bool simulates = plugin.descriptor && plugin.layer == GAITD_LAYER_BACKEND &&
                           (plugin.descriptor->capabilities & GAITD_CAPABILITY_SIMULATION) != 0;
    if (simulates) names.push_back(plugin.variant);
  }
  return names;
}

Names variant_names(const Names& words) {
  for (auto word = words.rbegin(); word != words.rend(); ++word) {
    if (const auto layer = daemon::layer_from_name(*word)) return plugins().variants(*layer);
  }
  std::set<std::string> names;
  for (int layer = 0; layer < GAITD_LAYER_COUNT; ++layer) {
    for (std::string& name : plugins().variants(layer)) names.insert(std::move(name));
  }
  return {names.begin(), names.end()};
}

Names link_names() {
  std::set<std::string> names;
  for_each_robot([&](const GaitdModel& model) {
    for (std::string& name : daemon::body_names(model)) names.insert(std::move(name));
  });
  return {names.begin(), names.end()};
}

Names joint_names() {
  std::set<std::string> names;
  for_each_robot([&](const GaitdModel& model) {
    for (int i = 0; i < model.joint_count; ++i) names.insert(model.joints[i].name);
  });
  return {names.begin(), names.end()};
}

Names setting_names() {
  std::set<std::string> names;
  for (const std::string_view key : kScenarioKeys) names.insert(std::string(key) + "=");
  for (const std::string& key : parameter_names()) names.insert(key + "=");
  daemon::Settings settings;
  daemon::Issues ignored;
  daemon::read_daemon_config(&settings, &ignored);
  for (const std::string& key : settings.known_keys()) names.insert(key + "=");
  for (int layer = 0; layer < GAITD_LAYER_COUNT; ++layer) {
    const std::string key = std::string(daemon::layer_name(layer)) + ".variant=";
    for (const std::string& variant : plugins().variants(layer)) names.insert(key + variant);
  }
  for (const std::string& backend : backend_names()) names.insert("backend=" + backend);
  return {names.begin(), names.end()};
}

Names parameter_names() {
  daemon::LiveParameters all;
  daemon::add_all_parameters(plugins().list(), &all);
  std::set<std::string> names;
  for (int i = 0; i < all.size(); ++i) names.insert(all.row(i).key);
  return {names.begin(), names.end()};
}

}  // namespace gaitd::cli
