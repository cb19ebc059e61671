// SPDX-License-Identifier: Apache-2.0
#include "daemon/verdict/run_data.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "daemon/log/glob.h"

namespace gaitd::daemon {

namespace {

using Json = nlohmann::json;

// All signals that any figure looks at, besides those that the checks of a scenario name.
constexpr std::array<const char*, 19> kSignals = {
    "time",
    "safety/faults",
    "safety/state",
    "gait/*",
    "drive/step/*",
    "icp/*",
    "pelvis/*",
    "foot/*/z",
    "foot/*/contact",
    "toe_off/active",
    "truth/pelvis/*",
    "truth/foot/*/slip",
    "truth/foot/*/z",
    "wbc/*",
    "tick/*",
    "joint/*/torque_desired",
    "joint/*/velocity",
    "foot/*/force/z",
    "truth/foot/*/force/z",
};

Json read_json(const LogReader& log, const std::string& key, RobotDescription* robot) {
  const std::optional<std::string> text = log.metadata_value(key);
  if (!text) {
    robot->problems.push_back("the log has no metadata '" + key + "'");
    return {};
  }
  Json json = Json::parse(*text, nullptr, false);
  if (json.is_discarded()) {
    robot->problems.push_back("metadata '" + key + "': not JSON");
    return {};
  }
  return json;
}

void read_joints(const Json& json, RobotDescription* robot) {
  for (const Json& joint : json) {
    robot->effort_limits[joint.at("name").get<std::string>()] =
        joint.at("effort_limit").get<double>();
  }
}

LegDescription read_leg(const Json& json) {
  LegDescription leg;
  if (json.contains("knee") && !json.at("knee").is_null()) {
    leg.knee = json.at("knee").get<std::string>();
  }
  leg.knee_bend_sign = json.value("knee_bend_sign", 1.0);
  leg.knee_straight = json.value("knee_straight", 0.0);
  leg.joints = json.value("joints", std::vector<std::string>());
  return leg;
}

}  // namespace

RobotDescription read_robot_description(const LogReader& log) {
  RobotDescription robot;
  const auto read = [&](const std::string& key, const auto& take) {
    const Json json = read_json(log, key, &robot);
    if (json.is_null()) return;
    try {
      take(json);
    } catch (const Json::exception& exception) {
      robot.problems.push_back("metadata '" + key + "': " + exception.what());
    }
  };
  read("joints", [&](const Json& json) { read_joints(json, &robot); });
  read("legs", [&](const Json& json) {
    for (std::size_t i = 0; i < 2; ++i) robot.legs[i] = read_leg(json.at(kSides[i]));
  });
  read("fault_bits", [&](const Json& json) {
    const int bit = json.at("fall").get<int>();
    if (bit >= 0 && bit < 53) robot.fall_bit = bit;
  });
  return robot;
}

RunData::RunData(const LogReader& log, const Expectations& expectations)
    : table_(log.signals()), robot_(read_robot_description(log)) {
  read_columns(log, expectations);
  read_phases();
}

void RunData::read_columns(const LogReader& log, const Expectations& expectations) {
  std::vector<std::string> globs(kSignals.begin(), kSignals.end());
  for (const LegDescription& leg : robot_.legs) globs.push_back("joint/" + leg.knee + "/position");
  for (const SignalCheck& check : expectations.checks) globs.push_back(check.signal);
  std::vector<int> wanted;
  for (std::size_t i = 0; i < table_.size(); ++i) {
    const bool any = std::any_of(globs.begin(), globs.end(), [&](const std::string& glob) {
      return glob_match(glob, table_[i].name);
    });
    if (any) wanted.push_back(static_cast<int>(i));
  }
  ticks_ = log.tick_count();
  std::vector<Column> columns = log.columns(wanted);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    columns_.emplace(table_[static_cast<std::size_t>(wanted[i])].name, std::move(columns[i]));
  }
  if (const Column* time = find("time")) {
    time_ = *time;
  } else {
    for (std::size_t tick = 0; tick < ticks_; ++tick) time_.push_back(static_cast<double>(tick));
  }
}

void RunData::read_phases() {
  phase_.assign(ticks_, Phase::kUnknown);
  support_.assign(ticks_, -1);
  const std::array<std::pair<const char*, Phase>, 3> phases = {
      {{"stand", Phase::kStand}, {"transfer", Phase::kTransfer}, {"swing", Phase::kSwing}}};
  for (const auto& [word, phase] : phases) {
    const std::vector<bool> there = has_word("gait/phase", word);
    for (std::size_t tick = 0; tick < there.size(); ++tick) {
      if (there[tick]) phase_[tick] = phase;
    }
  }
  controlled_.assign(ticks_, find("safety/state") == nullptr);
  for (const char* word : {"standing", "walking", "stopping"}) {
    const std::vector<bool> there = has_word("safety/state", word);
    for (std::size_t tick = 0; tick < there.size(); ++tick) {
      if (there[tick]) controlled_[tick] = true;
    }
  }
  // A robot that is not controlled any more does not walk, whatever it was at.
  for (std::size_t tick = 0; tick < ticks_; ++tick) {
    if (!controlled_[tick]) phase_[tick] = Phase::kUnknown;
  }
  for (int side = 0; side < 2; ++side) {
    const std::vector<bool> there =
        has_word("gait/support", kSides[static_cast<std::size_t>(side)]);
    for (std::size_t tick = 0; tick < there.size(); ++tick) {
      if (there[tick]) support_[tick] = side;
    }
  }
}

const Column* RunData::find(const std::string& name) const {
  const auto found = columns_.find(name);
  return found == columns_.end() ? nullptr : &found->second;
}

const Column* RunData::find_first(const std::vector<std::string>& names) const {
  for (const std::string& name : names) {
    if (const Column* column = find(name)) return column;
  }
  return nullptr;
}

bool RunData::is_during(std::size_t tick, During during) const {
  const Phase phase = phase_[tick];
  switch (during) {
    case During::kAlways:
      return true;
    case During::kStand:
      return phase == Phase::kStand;
    case During::kTransfer:
      return phase == Phase::kTransfer;
    case During::kSwing:
      return phase == Phase::kSwing;
    case During::kWalk:
      return phase == Phase::kTransfer || phase == Phase::kSwing;
  }
  return false;
}

std::vector<bool> RunData::has_word(const std::string& name, std::string_view word) const {
  const int signal = find_signal(table_, name);
  const Column* column = find(name);
  if (signal < 0 || column == nullptr) return {};
  const int value = find_word(table_[static_cast<std::size_t>(signal)], word);
  if (value < 0) return {};
  std::vector<bool> there(column->size());
  for (std::size_t tick = 0; tick < column->size(); ++tick) {
    there[tick] = (*column)[tick] == value;
  }
  return there;
}

}  // namespace gaitd::daemon
