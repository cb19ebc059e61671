// SPDX-License-Identifier: Apache-2.0
#include "cli/status_view.h"

#include <cstdio>
#include <sstream>

#include "cli/print.h"
#include "cli/table.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;

// status at "log/file", say; null if it is not there.
json at(const json& status, const std::string& pointer) {
  const json::json_pointer path("/" + pointer);
  return status.is_object() && status.contains(path) ? status.at(path) : json();
}

std::string text(const json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_null() || value.is_structured()) return "-";
  return value.dump();
}

// A number in units of `scale` with a fixed count of digits: columns do not jump.
std::string number(const json& value, int digits, double scale = 1.0) {
  if (!value.is_number()) return "-";
  char out[40];
  std::snprintf(out, sizeof(out), "%.*f", digits, value.get<double>() / scale);
  return out;
}

std::string right(const std::string& value, std::size_t width) {
  return value.size() < width ? std::string(width - value.size(), ' ') + value : value;
}

std::string faults(const json& status) {
  std::string names;
  const json list = at(status, "faults");
  for (const json& fault : list.is_array() ? list : json::array()) {
    names += (names.empty() ? "" : ", ") + text(fault);
  }
  if (names.empty()) names = "none";
  const json dropped = at(status, "joints_dropped");
  if (!dropped.is_number() || dropped == 0) return names;
  return names + "; walks on without " + text(dropped) + (dropped == 1 ? " joint" : " joints");
}

std::string steps(const json& status) {
  return text(at(status, "step_index")) + ", " + text(at(status, "footsteps_ahead")) + " ahead" +
         (at(status, "paused") == true ? ", paused" : "");
}

std::string gait(const json& status) {
  return text(at(status, "mode")) + ", " + text(at(status, "phase")) + ", support " +
         text(at(status, "support"));
}

std::string pose(const json& pose) {
  return "x " + number(at(pose, "x"), 3) + "  y " + number(at(pose, "y"), 3) + "  z " +
         number(at(pose, "z"), 3) + " m  yaw " + number(at(pose, "yaw"), 3) + " rad";
}

std::string log(const json& log) {
  const std::string file = text(at(log, "file"));
  if (file.empty() || file == "-") return "none";
  const std::string error = text(at(log, "error"));
  if (text(at(log, "open")) == "false") return "STOPPED: " + error;
  return file + ", " + number(at(log, "bytes"), 1, 1e6) + " MB, " + text(at(log, "dropouts")) +
         " ticks dropped";
}

// Of a robot; a simulation has none.
std::string health(const json& health) {
  if (!health.is_object()) return "-";
  std::string counts;
  for (const char* name : {"late", "missing", "duplicate", "stale", "lost", "unsent"}) {
    const json count = at(health, name);
    if (count.is_number() && count != 0) counts += std::string(", ") + name + " " + count.dump();
  }
  const bool healthy = at(health, "healthy") == true;
  return (healthy ? "healthy" : text(at(health, "text"))) + counts;
}

std::string triple(const json& values, int digits) {
  std::string words;
  for (const json& value : values) words += (words.empty() ? "" : ", ") + number(value, digits);
  return words;
}

// The force that pulls at the robot.
std::string pull(const json& external) {
  const json force = at(external, "force");
  if (!force.is_array() || force.size() != 3)
    return "unknown: no tare yet, or feet without force sensors";
  return triple(force, 0) + " N" + (at(external, "pulled") == true ? ", counted on" : "");
}

}  // namespace

std::string state_text(const json& status) {
  const std::string last = text(at(status, "state"));
  if (at(status, "stale") != true) return last;
  const json inside = at(status, "hangs_in");
  const std::string where = inside.is_string() ? " (hangs in " + text(inside) + ")" : "";
  return "STALE: no tick for " + number(at(status, "age"), 1) + " s" + where + ", then " + last;
}

std::string handholds_text(const json& handholds) {
  std::string words;
  for (const auto& [hand, handhold] : handholds.items()) {
    const json state = at(handhold, "state");
    if (state == "none") continue;
    words += (words.empty() ? "" : "; ") + hand + " hand, " + text(state) + ", up to " +
             number(at(handhold, "force_max"), 0) + " N";
  }
  return words.empty() ? "nothing" : words;
}

std::string payload_text(const json& payload) {
  const json loads = at(payload, "loads");
  if (!loads.is_array() || loads.empty()) return "nothing";
  std::string words;
  for (const json& load : loads) {
    words += (words.empty() ? "" : "; ") + number(at(load, "mass"), 2) + " kg on " +
             text(at(load, "link")) + " at " + triple(at(load, "com"), 3) + " m";
    const json uncertainty = at(load, "uncertainty");
    if (uncertainty.is_array()) words += " (within " + triple(uncertainty, 3) + ")";
  }
  return words;
}

std::vector<std::string> status_screen(const json& status) {
  std::vector<std::string> lines = {
      "gaitd " + text(at(status, "version")) + "  " + text(at(status, "robot")) + " on " +
          text(at(status, "backend")) + ", " + text(at(status, "clock")) + "  tick " +
          text(at(status, "tick")) + "  " + number(at(status, "time"), 2) + " s",
      "",
      "state      " + state_text(status),
      "faults     " + faults(status),
      "health     " + health(at(status, "health")),
      "gait       " + gait(status),
      "step       " + steps(status),
      "ICP error  " + number(at(status, "icp_error"), 1, 1e-3) + " mm, margin " +
          number(at(status, "icp_margin"), 1, 1e-3) + " mm",
      "pull       " + pull(at(status, "external")),
      "carries    " + payload_text(at(status, "payload")) +
          (at(at(status, "payload"), "estimating") == true ? ", being weighed" : ""),
      "holds on   " + handholds_text(at(status, "handholds")),
      "pelvis     " + pose(at(status, "pelvis")),
      "log        " + log(at(status, "log")),
      ""};
  std::vector<std::vector<std::string>> rows;
  const json layers = at(status, "layers");
  for (const json& layer : layers.is_array() ? layers : json::array()) {
    rows.push_back({text(at(layer, "layer")), text(at(layer, "variant")),
                    right(number(at(layer, "time_us"), 1), 8),
                    right(number(at(layer, "longest_us"), 1), 11)});
  }
  rows.push_back({"whole tick", "", right(number(at(status, "tick_us"), 1), 8),
                  right(number(at(status, "tick_longest_us"), 1), 11)});
  std::istringstream layer_table(table({"layer", "variant", " last µs", " longest µs"}, rows));
  for (std::string line; std::getline(layer_table, line);) lines.push_back(line);
  return lines;
}

std::string status_line(const json& status) {
  return number(at(status, "time"), 2) + " s  " + state_text(status) + "  " + gait(status) +
         "  step " + steps(status) + "  ICP error " + number(at(status, "icp_error"), 1, 1e-3) +
         " mm  margin " + number(at(status, "icp_margin"), 1, 1e-3) + " mm  tick " +
         number(at(status, "tick_longest_us"), 0) + " µs  faults " + faults(status);
}

}  // namespace gaitd::cli
