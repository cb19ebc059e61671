// SPDX-License-Identifier: Apache-2.0
// What a scenario says about the sensor from which the map of the ground is made.
#include <array>
#include <utility>

#include "daemon/config/scenario_sections.h"
#include "gaitd/sim/range_sensor_keys.h"

namespace gaitd::daemon {

nlohmann::json read_perception(MapReader map) {
  if (!map.valid()) return {};
  map.require({"sensor"});
  const int sensor = map.choice("sensor", sim::kRangeSensorClasses).value_or(0);
  nlohmann::json result = {{"sensor", sim::kRangeSensorClasses[static_cast<std::size_t>(sensor)]}};
  for (const sim::RangeSensorKey& key : sim::kRangeSensorKeys) {
    const auto value = map.number(key.name, {key.minimum, key.maximum, key.unit});
    if (value) result[std::string(key.name)] = *value;
  }
  if (const auto link = map.text("link")) result["link"] = *link;
  const std::pair<const char*, Bounds> kPlace[] = {{"position", {-10.0, 10.0, "m"}},
                                                   {"rpy", {-6.3, 6.3, "rad"}}};
  for (const auto& [key, bounds] : kPlace) {
    if (!map.has(key)) continue;
    if (!map.has("link")) map.fail(key, "the link in whose frame it is", "nothing", "add link");
    std::array<double, 3> values{};
    if (map.numbers(key, values, bounds)) result[key] = values;
  }
  map.finish();
  return result;
}

}  // namespace gaitd::daemon
