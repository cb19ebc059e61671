// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/config.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "gaitd/terrain/height_map_file.h"
#include "json_reader.h"
#include "read_sensor_figures.h"

namespace gaitd::sim {
namespace {

using nlohmann::json;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Range kAny{-kInfinity, kInfinity};
constexpr Range kPlace{-1e4, 1e4};
constexpr Range kNotNegative{0, kInfinity};
constexpr Range kHoist{0.02, 0.2};
constexpr Range kFriction{0, 10};
constexpr Range kStiffness{2e4, 1e7};
constexpr Range kDelay{0, 0.1};

void read_whole(const char* key, JsonReader* reader, uint64_t* result) {
  if (!reader->has(key)) return;
  const json& value = reader->at(key);
  if (value.is_number_integer() && (value.is_number_unsigned() || value.get<int64_t>() >= 0)) {
    *result = value.get<uint64_t>();
  } else {
    reader->error(reader->path(key), "an integer >= 0", value);
  }
}

void read_start(const json& value, std::vector<std::string>* errors, StartConfig* start) {
  JsonReader reader(value, "start", errors);
  reader.allow({"x", "y", "z", "yaw", "hoist"});
  reader.number("x", kPlace, &start->x);
  reader.number("y", kPlace, &start->y);
  reader.number("z", kPlace, &start->z);
  reader.number("yaw", kAny, &start->yaw);
  if (!reader.has("hoist")) return;
  JsonReader hoist(reader.at("hoist"), "start.hoist", errors);
  hoist.allow({"height"});
  hoist.number("height", kHoist, &start->hoist.emplace().height);
}

void read_height_map(const JsonReader& reader, std::vector<std::string>* errors,
                     TerrainConfig* terrain) {
  const json& file = reader.at("height_map");
  if (!file.is_string()) {
    errors->push_back("terrain.height_map: expected the YAML file of a height map, got " +
                      file.dump());
    return;
  }
  std::string error;
  auto map = terrain::load_height_map(file.get<std::string>(), &error);
  if (!map) {
    errors->push_back("terrain.height_map: " + error);
    return;
  }
  terrain->height_map = std::make_shared<const terrain::HeightMap>(std::move(*map));
}

void read_terrain(const json& value, std::vector<std::string>* errors, TerrainConfig* terrain) {
  JsonReader reader(value, "terrain", errors);
  reader.allow({"friction", "stiffness", "ground_z", "boxes", "height_map"});
  reader.number("friction", kFriction, &terrain->friction);
  reader.number("stiffness", kStiffness, &terrain->stiffness);
  reader.number("ground_z", kPlace, &terrain->ground_z);
  if (reader.has("height_map")) read_height_map(reader, errors, terrain);
  if (!reader.has("boxes")) return;
  if (!reader.at("boxes").is_array()) {
    reader.error("terrain.boxes", "a list of boxes", reader.at("boxes"));
    return;
  }
  size_t index = 0;
  for (const json& item : reader.at("boxes")) {
    const std::string path = "terrain.boxes[" + std::to_string(index++) + "]";
    JsonReader box_reader(item, path, errors);
    box_reader.allow({"center", "size", "rpy", "friction"});
    BoxConfig box;
    box.friction = terrain->friction;
    for (const char* key : {"center", "size"}) {
      if (!box_reader.has(key)) box_reader.error(box_reader.path(key), "three numbers", nullptr);
    }
    box_reader.vector("center", kPlace, &box.center);
    box_reader.vector("size", {0, 1e4, true}, &box.size);
    box_reader.vector("rpy", kAny, &box.rpy);
    box_reader.number("friction", kFriction, &box.friction);
    terrain->boxes.push_back(box);
  }
}

void read_sensor_faults(const json& list, const GaitdModel& model, std::vector<std::string>* errors,
                        std::vector<SensorFault>* faults) {
  if (!list.is_array()) {
    errors->push_back("sensors.faults: expected a list, got " + list.dump());
    return;
  }
  for (std::size_t i = 0; i < list.size(); ++i) {
    JsonReader reader(list[i], "sensors.faults[" + std::to_string(i) + "]", errors);
    reader.allow({"sensor", "kind", "from", "duration"});
    SensorFault fault;
    const json name = reader.has("sensor") ? reader.at("sensor") : json();
    const std::string sensor = name.is_string() ? name.get<std::string>() : std::string();
    if (!find_sensor(model, sensor, &fault)) {
      errors->push_back(reader.path("sensor") +
                        ": expected imu, left_foot, right_foot or the name of a joint, got \"" +
                        sensor + "\"");
    }
    const json kind = reader.has("kind") ? reader.at("kind") : json();
    const auto* found = std::find_if(std::begin(kSensorFaultKinds), std::end(kSensorFaultKinds),
                                     [&](const char* name) { return kind == name; });
    if (found == std::end(kSensorFaultKinds)) {
      reader.error(reader.path("kind"), "freeze, nan, spike, dead or silent", kind);
    }
    fault.kind = static_cast<SensorFault::Kind>(found - std::begin(kSensorFaultKinds));
    reader.number("from", kNotNegative, &fault.from);
    reader.number("duration", kNotNegative, &fault.duration);
    faults->push_back(fault);
  }
}

void read_sensors(const json& value, const GaitdModel& model, std::vector<std::string>* errors,
                  Config* config) {
  JsonReader reader(value, "sensors", errors);
  reader.allow({"noise", "faults", "episode"});
  read_whole("episode", &reader, &config->episode);
  if (reader.has("faults")) {
    read_sensor_faults(reader.at("faults"), model, errors, &config->sensor_faults);
  }
  if (reader.has("noise")) {
    read_sensor_figures(reader.at("noise"), "sensors.noise", errors, &config->sensors);
  }
}

void read_actuators(const json& value, std::vector<std::string>* errors, Config* config) {
  ActuatorFigures* const figures = &config->actuators;
  JsonReader reader(value, "actuators", errors);
  reader.allow({"model"});
  if (!reader.has("model")) return;
  const json& model = reader.at("model");
  if (model == "ideal") return;
  if (model == "nominal") {
    *figures = ActuatorFigures::nominal();
    return;
  }
  DriveFigures drives;
  if (model.is_string() && find_drive_class(model.get<std::string>(), &drives)) {
    config->drives = drives;
    return;
  }
  if (!model.is_object()) {
    reader.error("actuators.model",
                 "ideal, nominal, hydraulic, harmonic, quasi_direct or a map of figures", model);
    return;
  }
  if (model.contains("class")) {
    config->drives = read_drive_figures(model, "actuators.model", errors);
    return;
  }
  JsonReader map(model, "actuators.model", errors);
  map.allow({"command_delay", "bandwidth", "torque_noise", "coulomb_friction", "speed_derating"});
  map.number("command_delay", kDelay, &figures->command_delay);
  map.number("bandwidth", kNotNegative, &figures->bandwidth);
  map.number("torque_noise", {0, 1}, &figures->torque_noise);
  map.number("coulomb_friction", {0, 1}, &figures->coulomb_friction);
  map.number("speed_derating", kNotNegative, &figures->speed_derating);
  if (figures->speed_derating != 0 && figures->speed_derating <= 1) {
    map.error("actuators.model.speed_derating", "0 or a number > 1", map.at("speed_derating"));
  }
}

std::string body_names(const GaitdModel& model) {
  std::string names;
  for (int i = 0; i < model.body_count; ++i)
    names += (i ? ", " : "") + std::string(model.bodies[i].name);
  return names;
}

// Index of the body called `name`, or -1 and an error.
int find_body(const GaitdModel& model, const std::string& path, const std::string& name,
              std::vector<std::string>* errors) {
  for (int i = 0; i < model.body_count; ++i) {
    if (name == model.bodies[i].name) return i;
  }
  errors->push_back(path + ": expected a moving link of the robot (" + body_names(model) +
                    "), got \"" + name + "\"");
  return -1;
}

void read_model_error(const json& value, const GaitdModel& model, std::vector<std::string>* errors,
                      Config* config) {
  JsonReader reader(value, "model_error", errors);
  reader.allow({"mass_scale", "com_offset", "inertia_scale", "friction"});
  reader.number("friction", {0, 100}, &config->friction_scale);
  for (const char* key : {"mass_scale", "com_offset", "inertia_scale"}) {
    if (!reader.has(key)) continue;
    JsonReader map(reader.at(key), reader.path(key), errors);
    for (const auto& [name, figure] : map.object().items()) {
      const int body = find_body(model, map.path(name), name, errors);
      BodyError unused;
      BodyError& error = body < 0 ? unused : config->body_errors[static_cast<size_t>(body)];
      if (key == std::string("com_offset")) {
        map.vector(name.c_str(), {-10, 10}, &error.com_offset);
      } else if (key == std::string("mass_scale")) {
        map.number(name.c_str(), {0, 100, true}, &error.mass_scale);
      } else {
        map.number(name.c_str(), {0, 100, true}, &error.inertia_scale);
      }
    }
  }
}

void read_top(const json& root, const GaitdModel& model, double period,
              std::vector<std::string>* errors, Config* config) {
  JsonReader reader(root, "", errors);
  reader.allow({"start", "seed", "time_step", "terrain", "sensors", "actuators", "model_error"});
  read_whole("seed", &reader, &config->seed);
  reader.number("time_step", {1e-5, 2e-3}, &config->time_step);
  const double steps = period / config->time_step;
  if (std::abs(steps - std::round(steps)) > 1e-6 || steps < 0.5) {
    errors->push_back("time_step: expected a whole fraction of the control period " +
                      json(period).dump() + " s, got " + json(config->time_step).dump());
  }
  if (reader.has("start")) read_start(reader.at("start"), errors, &config->start);
  if (reader.has("terrain")) read_terrain(reader.at("terrain"), errors, &config->terrain);
  if (!config->terrain.ground_z && !config->start.z) {
    errors->push_back(
        "start.z: expected the height of the soles, as there is no "
        "terrain.ground_z, got nothing");
  }
  if (reader.has("sensors")) {
    read_sensors(reader.at("sensors"), model, errors, config);
  }
  if (reader.has("actuators")) read_actuators(reader.at("actuators"), errors, config);
  if (reader.has("model_error")) {
    read_model_error(reader.at("model_error"), model, errors, config);
  }
}

}  // namespace

ActuatorFigures ActuatorFigures::nominal() {
  ActuatorFigures f;
  f.command_delay = 0.001;
  f.bandwidth = 60;
  f.torque_noise = 0.005;
  f.coulomb_friction = 0.01;
  f.speed_derating = 1.5;
  return f;
}

Config parse_config(const std::string& text, const GaitdModel& model, double period,
                    std::vector<std::string>* errors) {
  Config config;
  config.body_errors.resize(static_cast<size_t>(model.body_count));
  if (!(period > 0) || !std::isfinite(period)) {
    errors->push_back("period: expected a number > 0, got " + json(period).dump());
    return config;
  }
  try {
    read_top(json::parse(text), model, period, errors, &config);
  } catch (const json::parse_error& error) {
    errors->push_back("configuration: expected JSON text, got: " + std::string(error.what()));
  }
  return config;
}

}  // namespace gaitd::sim
