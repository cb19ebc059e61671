// SPDX-License-Identifier: Apache-2.0
// What a scenario says about the sensors of the simulated robot.
#include <array>

#include "daemon/config/scenario_sections.h"

namespace gaitd::daemon {
namespace {

constexpr std::size_t kMaxSensorFaults = 100;
constexpr std::array<std::string_view, 5> kSensorFaultKinds = {"freeze", "nan", "spike", "dead",
                                                               "silent"};
constexpr std::array<std::string_view, 4> kSensorClasses = {"none", "nominal", "lab", "rough"};
constexpr std::array<std::string_view, 2> kStamps = {"measurement", "arrival"};

struct Figure {
  std::string_view name;
  Bounds bounds;
};

// The names and bounds of the simulator.
constexpr Figure kSensorFigures[] = {
    {"joint_zero", {-1.0, 1.0, "rad"}},
    {"encoder_bits", {0.0, 48.0, ""}},
    {"encoder_noise", {0.0, 1.0, "rad"}},
    {"velocity_filter", {0.0, 1e5, "Hz"}},
    {"spike_rate", {0.0, 100.0, "1/s"}},
    {"spike_size", {0.0, 10.0, "rad"}},
    {"gyro_noise", {0.0, 10.0, "rad/s"}},
    {"gyro_bias", {0.0, 10.0, "rad/s"}},
    {"gyro_walk", {0.0, 1.0, "rad/s/sqrt(s)"}},
    {"gyro_g_sensitivity", {0.0, 1.0, "rad/s per m/s^2"}},
    {"accelerometer_noise", {0.0, 100.0, "m/s^2"}},
    {"accelerometer_bias", {0.0, 100.0, "m/s^2"}},
    {"imu_scale", {0.0, 0.5, ""}},
    {"imu_misalignment", {0.0, 1.0, "rad"}},
    {"imu_filter", {0.0, 1e5, "Hz"}},
    {"strike_vibration", {0.0, 1e4, "m/s^2 per m/s"}},
    {"strike_rotation", {0.0, 1e4, "rad/s per m/s"}},
    {"strike_frequency", {0.0, 1e3, "Hz"}},
    {"force_noise", {0.0, 1e4, "N"}},
    {"force_offset", {0.0, 1e4, "N"}},
    {"force_drift", {0.0, 1e4, "N in 5 min"}},
    {"force_jump", {0.0, 1e4, "N"}},
    {"force_jump_share", {0.0, 1.0, ""}},
    {"force_scale", {0.0, 0.5, ""}},
    {"force_crosstalk", {0.0, 0.5, ""}},
    {"force_crosstalk_pair", {0.0, 0.5, ""}},
    {"moment_noise", {0.0, 1e4, "N m"}},
    {"moment_offset", {0.0, 1e4, "N m"}},
    {"foot_inertia", {0.0, 1.0, ""}},
    {"delay", {0.0, 0.1, "s"}},
    {"joint_delay", {0.0, 0.1, "s"}},
    {"imu_delay", {0.0, 0.1, "s"}},
    {"foot_delay", {0.0, 0.1, "s"}},
    {"jitter", {0.0, 0.1, "s"}},
    {"jitter_tail", {0.0, 0.1, "s"}},
    {"lost_frames", {0.0, 1.0, ""}},
    {"lost_burst", {1.0, 100.0, ""}},
};

// A number, or the limits [low, high] of what is drawn.
void read_figure(MapReader* map, const Figure& figure, nlohmann::json* result) {
  const NodePtr node = map->node(figure.name);
  if (!node) return;
  const std::string name(figure.name);
  if (node->kind != NodeKind::kList) {
    if (const auto value = map->number(figure.name, figure.bounds)) (*result)[name] = *value;
    return;
  }
  std::array<double, 2> limits{};
  if (!map->numbers(figure.name, limits, figure.bounds)) return;
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
    return std::string(
        kSensorClasses[static_cast<std::size_t>(map->choice("noise", kSensorClasses).value_or(0))]);
  }
  MapReader values = map->map("noise");
  nlohmann::json result = nlohmann::json::object();
  if (const auto base = values.choice("class", kSensorClasses)) {
    result["class"] = kSensorClasses[static_cast<std::size_t>(*base)];
  }
  if (const auto stamp = values.choice("stamp", kStamps)) {
    result["stamp"] = kStamps[static_cast<std::size_t>(*stamp)];
  }
  for (const Figure& figure : kSensorFigures) read_figure(&values, figure, &result);
  values.finish();
  return result;
}

}  // namespace

nlohmann::json read_sensors(MapReader map) {
  nlohmann::json result = {{"noise", read_noise(&map)}};
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
