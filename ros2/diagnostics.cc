// SPDX-License-Identifier: Apache-2.0
#include "ros2/diagnostics.h"

#include <cstdio>

namespace gaitd::ros2 {
namespace {

using nlohmann::json;

json at(const json& status, const std::string& pointer) {
  const json::json_pointer path(pointer);
  return status.is_object() && status.contains(path) ? status.at(path) : json();
}

std::string text(const json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.is_null() ? "-" : value.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string list(const json& values) {
  std::string result;
  for (const json& value : values.is_array() ? values : json::array()) {
    result += (result.empty() ? "" : ", ") + text(value);
  }
  return result;
}

std::string seconds(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof(buffer), "%.1f s", value);
  return buffer;
}

}  // namespace

Diagnosis diagnose_robot(const json& status, double silent) {
  Diagnosis result{.level = Level::kOk, .name = "gaitd: robot", .message = "", .values = {}};
  if (!status.is_object()) {
    result.level = Level::kStale;
    result.message = silent > 0.0 ? "gaitd has not answered for " + seconds(silent)
                                  : "gaitd has told nothing yet";
    return result;
  }
  for (const char* key : {"state", "mode", "phase", "support", "step_index", "footsteps_ahead",
                          "joints_dropped", "tick", "time", "robot", "backend", "version"}) {
    result.values.emplace_back(key, text(at(status, std::string("/") + key)));
  }
  const std::string faults = list(at(status, "/faults"));
  result.values.emplace_back("faults", faults);
  result.message = text(at(status, "/state"));
  const json age = at(status, "/age");
  const json dropped = at(status, "/joints_dropped");
  const json health = at(status, "/health/text");
  if (at(status, "/stale") == true) {
    result.level = Level::kStale;
    result.message = "no tick for " + seconds(age.is_number() ? age.get<double>() : 0.0) +
                     ", then " + result.message;
  } else if (!faults.empty() || at(status, "/state") == "fault") {
    result.level = Level::kError;
    result.message = "fault: " + faults;
  } else if (dropped.is_number() && dropped.get<double>() > 0.0) {
    result.level = Level::kWarn;
    result.message += ", walks on without " + text(dropped) + " of its joints";
  } else if (at(status, "/health/healthy") == false) {
    result.level = Level::kWarn;
    result.message += ", not healthy: " + text(health);
  }
  return result;
}

Diagnosis diagnose_timing(const json& status) {
  Diagnosis result{.level = Level::kOk, .name = "gaitd: real time", .message = "", .values = {}};
  if (!status.is_object()) {
    result.level = Level::kStale;
    result.message = "gaitd has told nothing yet";
    return result;
  }
  for (const char* key : {"/clock", "/overruns", "/whole_tick/median_us", "/whole_tick/max_us",
                          "/wake_up/max_us", "/late/what", "/log/error"}) {
    result.values.emplace_back(key + 1, text(at(status, key)));
  }
  const std::string degraded = list(at(status, "/realtime/degraded"));
  result.values.emplace_back("degraded", degraded);
  result.message = "in time";
  if (!degraded.empty()) {
    result.level = Level::kWarn;
    result.message = "degraded: " + degraded;
  }
  if (const json error = at(status, "/log/error"); error.is_string() && !text(error).empty()) {
    result.level = Level::kWarn;
    result.message += "; the log: " + text(error);
  }
  return result;
}

const diagnostic_msgs_msg_dds__DiagnosticArray_& DiagnosticMessage::fill(
    std::vector<Diagnosis> parts, const std::string& hardware, Stamp stamp) {
  parts_ = std::move(parts);
  hardware_ = hardware;
  values_.assign(parts_.size(), {});
  statuses_.assign(parts_.size(), {});
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Diagnosis& part = parts_[i];
    for (auto& [key, value] : part.values) values_[i].push_back({key.data(), value.data()});
    diagnostic_msgs_msg_dds__DiagnosticStatus_& status = statuses_[i];
    status.level = static_cast<std::uint8_t>(part.level);
    status.name = part.name.data();
    status.message = part.message.data();
    status.hardware_id = hardware_.data();
    status.values._buffer = values_[i].data();
    status.values._length = status.values._maximum = static_cast<std::uint32_t>(values_[i].size());
  }
  message_.header.stamp = stamp;
  message_.header.frame_id = no_frame_.data();
  message_.status._buffer = statuses_.data();
  message_.status._length = message_.status._maximum = static_cast<std::uint32_t>(statuses_.size());
  return message_;
}

}  // namespace gaitd::ros2
