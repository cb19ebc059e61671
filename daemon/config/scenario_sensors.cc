// SPDX-License-Identifier: Apache-2.0
// What a scenario says about the sensors of the simulated robot.
#include <array>

#include "daemon/config/scenario_sections.h"
#include "gaitd/sim/sensor_figure_keys.h"

namespace gaitd::daemon {
namespace {

constexpr std::size_t kMaxSensorFaults = 100;
constexpr std::array<std::string_view, 5> kSensorFaultKinds = {"freeze", "nan", "spike", "dead",
                                                               "silent"};

// A number, or the limits [low, high] of what is drawn.
void read_figure(MapReader* map, const sim::SensorFigureKey& figure, nlohmann::json* result) {
  const Bounds bounds = {figure.minimum, figure.maximum, figure.unit};
  const NodePtr node = map->node(figure.name);
  if (!node) return;
  const std::string name(figure.name);
  if (node->kind != NodeKind::kList) {
    if (const auto value = map->number(figure.name, bounds)) (*result)[name] = *value;
    return;
  }
  std::array<double, 2> limits{};
  if (!map->numbers(figure.name, limits, bounds)) return;
  if (limits[0] > limits[1]) {
    map->fail(figure.name, "the lower limit first", describe(*node), "swap the two limits");
    return;
  }
  (*result)[name] = limits;
}

nlohmann::json read_noise(MapReader* map) {
  const NodePtr node = map->node("noise");
  if (!node) return "none";
  if (node->kind != NodeKind::kMap) {
    return std::string(sim::kSensorClasses[static_cast<std::size_t>(
        map->choice("noise", sim::kSensorClasses).value_or(0))]);
  }
  MapReader values = map->map("noise");
  nlohmann::json result = nlohmann::json::object();
  if (const auto base = values.choice("class", sim::kSensorClasses)) {
    result["class"] = sim::kSensorClasses[static_cast<std::size_t>(*base)];
  }
  if (const auto stamp = values.choice("stamp", sim::kSensorStamps)) {
    result["stamp"] = sim::kSensorStamps[static_cast<std::size_t>(*stamp)];
  }
  read_figure(&values, sim::kSensorDelayKey, &result);
  for (const sim::SensorFigureKey& key : sim::kSensorFigureKeys) {
    read_figure(&values, key, &result);
  }
  values.finish();
  return result;
}

}  // namespace

nlohmann::json read_sensors(MapReader map) {
  nlohmann::json result = {{"noise", read_noise(&map)}};
  if (const auto episode = map.integer("episode", 0, 4294967295)) result["episode"] = *episode;
  const std::vector<NodePtr> faults = map.list("faults", 0, kMaxSensorFaults);
  for (std::size_t i = 0; i < faults.size(); ++i) {
    MapReader fault(faults[i], map.path_of("faults") + "[" + std::to_string(i) + "]", map.issues());
    fault.require({"sensor", "kind", "from", "duration"});
    result["faults"].push_back(
        {{"sensor", fault.text("sensor").value_or("")},
         {"kind", kSensorFaultKinds[fault.choice("kind", kSensorFaultKinds).value_or(0)]},
         {"from", fault.number("from", {0.0, 1e5, "s"}).value_or(0.0)},
         {"duration", fault.number("duration", {0.0, 1e5, "s"}).value_or(0.0)}});
    fault.finish();
  }
  map.finish();
  return result;
}

}  // namespace gaitd::daemon
