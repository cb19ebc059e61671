// SPDX-License-Identifier: Apache-2.0
#include "wiring.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "json_reader.h"
#include "sensor_frames.h"

namespace gaitd::can {
namespace {

using nlohmann::json;
using sim::JsonReader;
using sim::Range;
using Errors = std::vector<std::string>;

// Of a master on extended identifiers: beyond the motors, and 0xFE is for everybody.
constexpr uint32_t kFirstMaster = 0x80, kLastMaster = 0xFD;

std::string hex(uint32_t id) {
  char text[16];
  std::snprintf(text, sizeof(text), "0x%03X", id);
  return text;
}

void read_text(JsonReader* map, const char* key, std::string* value) {
  if (!map->has(key)) return;
  if (map->at(key).is_string()) {
    *value = map->at(key).get<std::string>();
  } else {
    map->error(map->path(key), "a text", map->at(key));
  }
}

// A number, or a text such as 0x14. All mini-cheetah motors reply with 0, so nobody else has it.
void read_id(JsonReader* map, const char* key, uint32_t last, uint32_t* id, uint32_t first = 1) {
  if (!map->has(key)) return;
  const json& value = map->at(key);
  long long number = -1;
  if (value.is_number_integer()) number = value.get<long long>();
  if (value.is_string()) {
    const std::string text = value.get<std::string>();
    char* end = nullptr;
    number = std::strtoll(text.c_str(), &end, 16);
    if (!text.starts_with("0x") || *end != '\0') number = -1;
  }
  if (number >= first && number <= last) {
    *id = static_cast<uint32_t>(number);
  } else {
    map->error(map->path(key), "an identifier " + hex(first) + ".." + hex(last), value);
  }
}

constexpr const char* kRanges[] = {"position", "velocity", "torque", "stiffness", "damping"};

// The keys that motors share and that one of them may say otherwise.
void read_motor_defaults(JsonReader* map, Motor* motor, Errors* errors) {
  std::string name = motor->dialect->name;
  read_text(map, "dialect", &name);
  if (const Dialect* dialect = find_dialect(name)) {
    motor->dialect = dialect;
  } else {
    map->error(map->path("dialect"), "one of " + dialect_names(), name);
  }
  map->number("gear", {0, 1000, true}, &motor->gear);
  if (!map->has("ranges")) return;
  JsonReader ranges(map->at("ranges"), map->path("ranges"), errors);
  ranges.allow({kRanges[0], kRanges[1], kRanges[2], kRanges[3], kRanges[4]});
  double* const values[] = {&motor->ranges.position, &motor->ranges.velocity, &motor->ranges.torque,
                            &motor->ranges.stiffness, &motor->ranges.damping};
  for (std::size_t i = 0; i < std::size(kRanges); ++i) {
    ranges.number(kRanges[i], {0, 1e5, true}, values[i]);
    if (ranges.has(kRanges[i])) motor->ranges_told |= 1u << i;
  }
}

class WiringReader {
 public:
  WiringReader(const GaitdModel& model, Errors* errors) : model_(model), errors_(errors) {}

  Wiring read(const json& document) {
    JsonReader root(document, "can", errors_);
    root.allow({"schema", "defaults", "buses", "joints", "imus", "feet", "estop", "motor_timeout"});
    std::string schema;
    read_text(&root, "schema", &schema);
    if (schema != "gaitd.can/1") {
      root.error("can.schema", "gaitd.can/1", schema.empty() ? json() : json(schema));
    }
    root.number("motor_timeout", {0.001, 10}, &wiring_.motor_timeout);
    if (root.has("defaults")) {
      JsonReader defaults(root.at("defaults"), "can.defaults", errors_);
      defaults.allow({"dialect", "gear", "ranges"});
      read_motor_defaults(&defaults, &defaults_, errors_);
    }
    read_buses(&root);
    read_joints(&root);
    read_senders(&root, "imus", kImuFrames, &wiring_.imus);
    read_senders(&root, "feet", kFootFrames, &wiring_.feet);
    read_estop(&root);
    return std::move(wiring_);
  }

 private:
  void read_buses(JsonReader* root) {
    if (!root->has("buses")) {
      root->error("can.buses", "the buses", nullptr);
      return;
    }
    JsonReader buses(root->at("buses"), "can.buses", errors_);
    std::set<std::string> interfaces;
    for (const auto& [name, value] : buses.object().items()) {
      JsonReader map(value, buses.path(name), errors_);
      map.allow({"interface", "bitrate", "data_bitrate"});
      Bus bus;
      bus.name = name;
      read_text(&map, "interface", &bus.interface);
      if (bus.interface.empty() || bus.interface.size() > 15) {
        map.error(map.path("interface"), "the name of a network interface", bus.interface);
      } else if (!interfaces.insert(bus.interface).second) {
        map.error(map.path("interface"), "an interface of its own for each bus", bus.interface);
      }
      map.number("bitrate", {10e3, 1e6}, &bus.rates.nominal);
      map.number("data_bitrate", {1e6, 8e6}, &bus.rates.data);
      wiring_.buses.push_back(bus);
    }
    if (wiring_.buses.empty() || wiring_.buses.size() > kMaxBuses) {
      root->error("can.buses", "1 to " + std::to_string(kMaxBuses) + " buses",
                  wiring_.buses.size());
    }
  }

  int bus_of(JsonReader* map) {
    std::string name;
    read_text(map, "bus", &name);
    for (size_t i = 0; i < wiring_.buses.size(); ++i) {
      if (wiring_.buses[i].name == name) return static_cast<int>(i);
    }
    std::string known;
    for (const Bus& bus : wiring_.buses) known += (known.empty() ? "" : ", ") + bus.name;
    map->error(map->path("bus"), "one of the buses " + known, name.empty() ? json() : json(name));
    return 0;
  }

  // Nobody else on the bus may use the identifier.
  void claim(int bus, uint32_t id, const std::string& path) {
    const auto [place, first] = used_.try_emplace({bus, id}, path);
    if (first) return;
    errors_->push_back(path + ": expected an identifier of its own on the bus, got " +
                       hex(id & ~kExtended) + ", which is " + place->second);
  }

  void read_joints(JsonReader* root) {
    if (!root->has("joints")) {
      root->error("can.joints", "a motor for every joint", nullptr);
      return;
    }
    JsonReader joints(root->at("joints"), "can.joints", errors_);
    for (int i = 0; i < model_.joint_count; ++i) {
      const char* name = model_.joints[i].name;
      if (joints.has(name)) {
        wiring_.motors.push_back(read_motor(i, joints.at(name), joints.path(name)));
      } else {
        joints.error(joints.path(name), "a motor for every joint of the model", nullptr);
      }
    }
    for (const auto& [name, value] : joints.object().items()) {
      const bool known =
          std::any_of(model_.joints, model_.joints + model_.joint_count,
                      [&name = name](const GaitdJoint& joint) { return name == joint.name; });
      if (!known) joints.error(joints.path(name), "a joint of the model", name);
    }
  }

  Motor read_motor(int joint, const json& value, const std::string& path) {
    JsonReader map(value, path, errors_);
    map.allow({"bus", "id", "reply_id", "dialect", "sign", "offset", "gear", "ranges", "limits"});
    Motor motor = defaults_;
    motor.joint = joint;
    read_motor_defaults(&map, &motor, errors_);
    motor.bus = bus_of(&map);
    read_ids(&map, &motor);
    map.number("sign", {-1, 1}, &motor.sign);
    if (std::abs(motor.sign) != 1) map.error(map.path("sign"), "1 or -1", motor.sign);
    map.number("offset", {-100, 100}, &motor.offset);
    read_limits(&map, &motor);
    check_ranges(motor, path);
    return motor;
  }

  void read_ids(JsonReader* map, Motor* motor) {
    const Dialect& dialect = *motor->dialect;
    if (!map->has("id")) map->error(map->path("id"), "an identifier", nullptr);
    read_id(map, "id", dialect.last_id, &motor->id);
    const bool extended = dialect.extended();
    claim(motor->bus, motor->id | (extended ? kExtended : 0), map->path("id"));
    const auto bus = static_cast<size_t>(motor->bus);  // there may be none at all
    if (!dialect.fd && bus < wiring_.buses.size() && wiring_.buses[bus].fd()) {
      map->error(map->path("bus"),
                 "a bus without data_bitrate, as " + std::string(dialect.name) +
                     " motors do not know CAN FD and disturb it",
                 wiring_.buses[bus].name);
    }
    if (extended) {
      motor->reply_id = kLastMaster;
      read_id(map, "reply_id", kLastMaster, &motor->reply_id, kFirstMaster);
      return;
    }
    if (dialect.route == ReplyRoute::kSharedZero) return;
    if (!map->has("reply_id")) map->error(map->path("reply_id"), "an identifier", nullptr);
    read_id(map, "reply_id", kLastId, &motor->reply_id);
    claim(motor->bus, motor->reply_id, map->path("reply_id"));
  }

  void read_limits(JsonReader* map, Motor* motor) {
    const GaitdJoint& joint = model_.joints[motor->joint];
    motor->torque_limit = joint.effort_limit;
    motor->velocity_limit = joint.velocity_limit;
    motor->position_min = joint.position_min;
    motor->position_max = joint.position_max;
    if (!map->has("limits")) return;
    JsonReader limits(map->at("limits"), map->path("limits"), errors_);
    limits.allow({"torque", "velocity", "position_min", "position_max"});
    limits.number("torque", {0, joint.effort_limit, true}, &motor->torque_limit);
    limits.number("velocity", {0, joint.velocity_limit, true}, &motor->velocity_limit);
    const Range range{joint.position_min, joint.position_max};
    limits.number("position_min", range, &motor->position_min);
    limits.number("position_max", range, &motor->position_max);
    if (!(motor->position_min < motor->position_max)) {
      limits.error(limits.path("position_min"), "less than position_max", motor->position_min);
    }
  }

  // A code that is clamped would be a wrong reading, and a wrong command.
  void check_ranges(const Motor& motor, const std::string& path) {
    // Gains that mean ten times as much move the robot ten times as hard.
    for (std::size_t i = 0; i < std::size(kRanges) && !motor.dialect->tells_ranges; ++i) {
      if ((motor.ranges_told >> i & 1u) != 0) continue;
      errors_->push_back(path + ".ranges." + kRanges[i] + ": expected that of the motor, as " +
                         motor.dialect->name + " motors do not tell it, got none");
    }
    const auto check = [&](const char* what, double needed, double range, const char* unit) {
      if (needed <= range) return;
      char text[200];
      std::snprintf(text, sizeof(text),
                    ": expected ranges.%s of at least %.4g %s at the motor, got %.4g; correct the "
                    "range, the gear or the offset, or set limits",
                    what, needed, unit, range);
      errors_->push_back(path + text);
    };
    check("position",
          std::max(std::abs(motor.motor_position(motor.position_min)),
                   std::abs(motor.motor_position(motor.position_max))),
          motor.ranges.position, "rad");
    check("velocity", std::abs(motor.motor_velocity(motor.velocity_limit)), motor.ranges.velocity,
          "rad/s");
    check("torque", std::abs(motor.motor_torque(motor.torque_limit)), motor.ranges.torque, "N m");
  }

  void read_senders(JsonReader* root, const char* key, int frames, std::vector<Sender>* senders) {
    const bool imus = std::strcmp(key, "imus") == 0;
    const int count = imus ? model_.imu_count : GAITD_MAX_FEET;
    const json nothing = json::object();
    JsonReader map(root->has(key) ? root->at(key) : nothing, root->path(key), errors_);
    for (int i = 0; i < count; ++i) {
      if (!imus && model_.feet[i].force_sensor.body < 0) continue;  // it has no sensor
      const std::string name = imus ? model_.imus[i].name : (i == GAITD_LEFT ? "left" : "right");
      if (!map.has(name.c_str())) {
        map.error(map.path(name), "its bus and identifier", nullptr);
        continue;
      }
      JsonReader entry(map.at(name.c_str()), map.path(name), errors_);
      entry.allow({"bus", "id"});
      Sender sender;
      sender.index = i;
      sender.bus = bus_of(&entry);
      if (!entry.has("id")) entry.error(entry.path("id"), "an identifier", nullptr);
      read_id(&entry, "id", kLastId - frames, &sender.id);
      for (int k = 0; k < frames; ++k) claim(sender.bus, sender.id + k, entry.path("id"));
      senders->push_back(sender);
    }
    if (static_cast<int>(map.object().size()) > static_cast<int>(senders->size())) {
      map.error(root->path(key), imus ? "the IMUs of the model" : "the feet that have a sensor",
                map.object());
    }
  }

  void read_estop(JsonReader* root) {
    if (!root->has("estop")) return;
    JsonReader map(root->at("estop"), "can.estop", errors_);
    map.allow({"bus", "id", "heartbeat"});
    wiring_.estop.bus = bus_of(&map);
    if (!map.has("id")) map.error(map.path("id"), "an identifier", nullptr);
    read_id(&map, "id", kLastId, &wiring_.estop.id);
    claim(wiring_.estop.bus, wiring_.estop.id, "can.estop.id");
    map.number("heartbeat", {0.005, 10}, &wiring_.heartbeat);
  }

  const GaitdModel& model_;
  Errors* errors_;
  Wiring wiring_;
  Motor defaults_;
  std::map<std::pair<int, uint32_t>, std::string> used_;
};

}  // namespace

double bus_load(const Wiring& wiring, int bus, double period) {
  const BitRates& rates = wiring.buses[bus].rates;
  double busy = 0;
  for (const Motor& motor : wiring.motors) {
    if (motor.bus != bus) continue;
    const bool extended = motor.dialect->extended();
    busy +=
        frame_time(rates, 8, extended) + frame_time(rates, motor.dialect->reply_length, extended);
  }
  for (const Sender& imu : wiring.imus) {
    if (imu.bus == bus) busy += kImuFrames * frame_time(rates, 8);
  }
  for (const Sender& foot : wiring.feet) {
    if (foot.bus == bus) busy += kFootFrames * frame_time(rates, 8);
  }
  return busy / period;
}

Wiring parse_wiring(const std::string& text, const GaitdModel& model, double period,
                    Errors* errors) {
  const json document = json::parse(text, nullptr, false);
  if (document.is_discarded()) {
    errors->push_back("can: expected JSON");
    return {};
  }
  Wiring wiring = WiringReader(model, errors).read(document);
  for (size_t i = 0; errors->empty() && i < wiring.buses.size(); ++i) {
    const double load = bus_load(wiring, static_cast<int>(i), period);
    if (load <= kMaxLoad) continue;
    char line[240];
    std::snprintf(line, sizeof(line),
                  "can.buses.%s: expected a load of at most %.0f %%, got %.1f %% at %.0f Hz; use "
                  "more buses, CAN FD or a longer period",
                  wiring.buses[i].name.c_str(), 100 * kMaxLoad, 100 * load, 1 / period);
    errors->push_back(line);
  }
  return wiring;
}

}  // namespace gaitd::can
