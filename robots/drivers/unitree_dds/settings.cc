// SPDX-License-Identifier: Apache-2.0
#include "settings.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "json_reader.h"

namespace gaitd::unitree {
namespace {

using nlohmann::json;
using sim::JsonReader;
using Errors = std::vector<std::string>;

constexpr std::array<const char*, 3> kControls = {"debug", "release", "user"};

void read_text(JsonReader* map, const char* key, std::string* value) {
  if (!map->has(key)) return;
  if (map->at(key).is_string()) {
    *value = map->at(key).get<std::string>();
  } else {
    map->error(map->path(key), "a text", map->at(key));
  }
}

void read_flag(JsonReader* map, const char* key, bool* value) {
  if (!map->has(key)) return;
  if (map->at(key).is_boolean()) {
    *value = map->at(key).get<bool>();
  } else {
    map->error(map->path(key), "true or false", map->at(key));
  }
}

void read_whole(JsonReader* map, const char* key, int minimum, int maximum, int* value) {
  if (!map->has(key)) return;
  const json& got = map->at(key);
  if (got.is_number_integer() && got.get<long long>() >= minimum &&
      got.get<long long>() <= maximum) {
    *value = got.get<int>();
  } else {
    map->error(map->path(key),
               "a whole number " + std::to_string(minimum) + ".." + std::to_string(maximum), got);
  }
}

void read_control(JsonReader* map, Control* control) {
  if (!map->has("control")) return;
  const auto found = std::find(kControls.begin(), kControls.end(), map->at("control"));
  if (found == kControls.end()) {
    map->error(map->path("control"), "debug, release or user", map->at("control"));
  } else {
    *control = static_cast<Control>(found - kControls.begin());
  }
}

// Joints that are called as the maker calls them need no line.
void read_joints(JsonReader* map, const GaitdModel& model, Settings* settings, Errors* errors) {
  const json none = json::object();
  JsonReader joints(map->has("joints") ? map->at("joints") : none, map->path("joints"), errors);
  uint64_t taken = 0;
  settings->joint_count = model.joint_count;
  for (int i = 0; i < model.joint_count; ++i) {
    const char* name = model.joints[i].name;
    int index = wire_index(name);
    if (joints.has(name)) {
      read_whole(&joints, name, 0, kMotors - 1, &index);
    } else if (index < 0) {
      joints.error(joints.path(name), "the motor index of a joint that the maker does not know",
                   nullptr);
    }
    if (model.joints[i].type != GAITD_JOINT_REVOLUTE) {
      joints.error(joints.path(name), "a revolute joint", "a prismatic one");
    }
    settings->wire[i] = std::max(0, index);
    if (index < 0) continue;
    if ((taken >> index & 1) != 0) {
      joints.error(joints.path(name), "a motor of its own", index);
    }
    taken |= uint64_t{1} << index;
  }
  for (const auto& [name, value] : joints.object().items()) {
    const bool known =
        std::any_of(model.joints, model.joints + model.joint_count,
                    [&name = name](const GaitdJoint& joint) { return name == joint.name; });
    if (!known) joints.error(joints.path(name), "a joint of the model", name);
  }
}

void read_numbers(JsonReader* map, Settings* s) {
  map->number("listen", {0.2, 3}, &s->listen);
  map->number("command_timeout", {0.004, 0.5}, &s->command_timeout);
  map->number("state_timeout", {0.004, 1}, &s->state_timeout);
  map->number("rate", {50, 1000}, &s->rate);
  map->number("damping", {0.5, 20}, &s->damping);
  map->number("damp_time", {0.2, 4}, &s->damp_time);
  map->number("max_stiffness", {0, 500}, &s->max_stiffness);
  map->number("max_damping", {0, 20}, &s->max_damping);
  map->number("lowest_charge", {0, 100}, &s->lowest_charge);
  map->number("lockstep_timeout", {0.001, 60}, &s->lockstep_timeout);
}

}  // namespace

uint64_t Settings::motor_mask() const {
  uint64_t mask = 0;
  for (int i = 0; i < joint_count; ++i) mask |= uint64_t{1} << wire[i];
  return mask;
}

Settings parse_settings(const std::string& text, const GaitdModel& model, Errors* errors) {
  Settings settings;
  const json document = json::parse(text, nullptr, false);
  JsonReader map(document, "unitree_dds", errors);
  map.allow({"can", "interface", "domain", "control", "give_back", "listen", "command_timeout",
             "state_timeout", "rate", "damping", "damp_time", "mode_machine", "feet",
             "max_stiffness", "max_damping", "lowest_charge", "lockstep_timeout", "joints"});
  read_text(&map, "interface", &settings.interface);
  if (settings.interface.empty() || settings.interface.size() > 15) {
    map.error(map.path("interface"), "the network interface to the robot, such as eth0",
              settings.interface.empty() ? json() : json(settings.interface));
  }
  read_whole(&map, "domain", 0, 232, &settings.domain);
  read_control(&map, &settings.control);
  read_flag(&map, "give_back", &settings.give_back);
  read_whole(&map, "mode_machine", 0, 255, &settings.mode_machine);
  read_text(&map, "feet", &settings.feet);
  read_numbers(&map, &settings);
  read_joints(&map, model, &settings, errors);
  return settings;
}

std::string to_text(const Settings& s) {
  json text = {{"interface", s.interface},
               {"domain", s.domain},
               {"control", static_cast<int>(s.control)},
               {"give_back", s.give_back},
               {"listen", s.listen},
               {"command_timeout", s.command_timeout},
               {"state_timeout", s.state_timeout},
               {"rate", s.rate},
               {"damping", s.damping},
               {"damp_time", s.damp_time},
               {"mode_machine", s.mode_machine},
               {"feet", s.feet},
               {"lowest_charge", s.lowest_charge},
               {"lockstep_timeout", s.lockstep_timeout}};
  text["wire"] = json::array();
  for (int i = 0; i < s.joint_count; ++i) text["wire"].push_back(s.wire[i]);
  return text.dump();
}

Settings from_text(const std::string& text) {
  const json map = json::parse(text);
  Settings s;
  map.at("interface").get_to(s.interface);
  map.at("domain").get_to(s.domain);
  s.control = static_cast<Control>(map.at("control").get<int>());
  map.at("give_back").get_to(s.give_back);
  map.at("listen").get_to(s.listen);
  map.at("command_timeout").get_to(s.command_timeout);
  map.at("state_timeout").get_to(s.state_timeout);
  map.at("rate").get_to(s.rate);
  map.at("damping").get_to(s.damping);
  map.at("damp_time").get_to(s.damp_time);
  map.at("mode_machine").get_to(s.mode_machine);
  map.at("feet").get_to(s.feet);
  map.at("lowest_charge").get_to(s.lowest_charge);
  map.at("lockstep_timeout").get_to(s.lockstep_timeout);
  const json& wire = map.at("wire");
  s.joint_count = static_cast<int>(std::min<size_t>(wire.size(), GAITD_MAX_JOINTS));
  for (int i = 0; i < s.joint_count; ++i) s.wire[i] = wire[i].get<int>();
  return s;
}

}  // namespace gaitd::unitree
