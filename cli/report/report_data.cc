// SPDX-License-Identifier: Apache-2.0
#include "cli/report/report_data.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "cli/installed_page.h"
#include "cli/whole_file.h"
#include "daemon/config/names.h"
#include "daemon/config/node.h"
#include "daemon/config/paths.h"
#include "daemon/config/scenario.h"
#include "daemon/server/base64.h"
#include "daemon/verdict/verdict.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;
using daemon::LogReader;
using nlohmann::json;

constexpr double kRowsPerSecond = 100.0;
constexpr std::size_t kMostRows = 12000;
// What the page shows.
constexpr char kShownSignals[] =
    "time,com/?,com/height_target,truth/com/z,icp/*,cmp/desired/*,cop/*,pelvis/*,foot/*,footstep/*,"
    "external/force/?,external/pulled,payload/?/*,handhold/*,leg/*,joint/*/position,joint/*/"
    "torque_desired,step_adjust/*,tick/*_us,gait/phase,"
    "gait/step_index,toe_off/active";

// Every n-th tick, so that neither bound is passed.
std::size_t stride_of(const LogReader& log) {
  const std::vector<double> time = log.column("time");
  if (time.size() < 2) return 1;
  const double period = (time.back() - time.front()) / static_cast<double>(time.size() - 1);
  const double by_rate = period > 0.0 ? std::round(1.0 / (kRowsPerSecond * period)) : 1.0;
  const std::size_t by_rows = (time.size() + kMostRows - 1) / kMostRows;
  return std::max({std::size_t{1}, static_cast<std::size_t>(by_rate), by_rows});
}

void add_signals(const LogReader& log, json* data) {
  const daemon::SignalTable& table = log.signals();
  std::vector<int> shown;
  for (const std::string& name : log.match(kShownSignals))
    shown.push_back(find_signal(table, name));
  const std::vector<std::vector<double>> columns = log.columns(shown);
  const std::size_t stride = stride_of(log);
  (*data)["rows"] = (log.tick_count() + stride - 1) / stride;
  (*data)["signals"] = json::array();
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const daemon::SignalDescription& signal = table[static_cast<std::size_t>(shown[i])];
    const bool keeps_longest = signal.name.starts_with("tick/");
    std::vector<float> rows;
    for (std::size_t tick = 0; tick < columns[i].size(); ++tick) {
      const auto value = static_cast<float>(columns[i][tick]);
      if (tick % stride == 0) {
        rows.push_back(value);
      } else if (keeps_longest) {
        rows.back() = std::max(rows.back(), value);
      }
    }
    (*data)["signals"].push_back(
        {{"name", signal.name},
         {"unit", signal.unit},
         {"words", signal.words},
         {"values", daemon::base64({reinterpret_cast<const char*>(rows.data()),
                                    rows.size() * sizeof(float)})}});
  }
}

// What was expected of the run is in its log; a scenario of the same name that is installed here
// may be another one.
json verdict_of(const LogReader& log) {
  const auto section = log.metadata_value("expect");
  const auto expected = section ? daemon::read_logged_expectations(*section) : std::nullopt;
  const daemon::Verdict verdict =
      daemon::compute_verdict(log, expected.value_or(daemon::Expectations()));
  json result = json::parse(daemon::verdict_json(verdict), nullptr, false);
  const daemon::VerdictWord word =
      daemon::verdict_word(verdict, expected.has_value(), log.damage().any());
  result["word"] = word.text;
  result["good"] = word.good;
  return result;
}

// As the log holds it, else as it is installed now.
void add_robot(const LogReader& log, json* data) {
  daemon::Issues issues;
  if (const auto yaml = log.metadata_value("robot_yaml")) {
    const daemon::NodePtr node = daemon::parse_yaml(*yaml, "robot.yaml", &issues);
    if (node != nullptr && issues.ok()) (*data)["robot"] = daemon::to_json(*node);
    (*data)["urdf"] = log.metadata_value("robot_urdf").value_or("");
    return;
  }
  const std::string name = log.metadata_value("robot").value_or("");
  if (!daemon::is_file_name(name)) return;  // no path of this machine
  const auto file = daemon::Paths::detect().robot(name);
  if (!file) return;
  const daemon::NodePtr node = daemon::load_yaml_file(file->string(), &issues);
  if (node == nullptr || !issues.ok()) return;
  (*data)["robot"] = daemon::to_json(*node);
  const auto* urdf = node->find("urdf");
  if (urdf != nullptr) (*data)["urdf"] = read_file(file->parent_path() / urdf->value->text);
}

json data_of(const LogReader& log) {
  json data;
  const std::string name = fs::path(log.path()).stem().string();
  const std::string scenario = log.metadata_value("scenario").value_or("");
  data["name"] = name;
  data["title"] = scenario.empty() ? name : scenario;
  json metadata = json::object();
  for (const auto& [key, value] : log.metadata()) {
    if (!key.starts_with("robot_")) metadata[key] = value;  // they have places of their own
  }
  for (const auto& [key, value] : log.end_metadata()) metadata[key] = value;
  data["metadata"] = metadata;
  data["world"] = json::parse(log.metadata_value("world").value_or("null"), nullptr, false);
  data["verdict"] = verdict_of(log);
  data["damage"] = log.damage().findings;
  data["events"] = json::array();
  for (const daemon::Event& event : log.events()) {
    const json text = json::parse(event.text, nullptr, false);
    data["events"].push_back({{"time", event.time},
                              {"kind", event.kind},
                              {"text", text.is_discarded() ? json(event.text) : text}});
  }
  add_robot(log, &data);
  add_signals(log, &data);
  return data;
}

}  // namespace

std::string report_data(const std::vector<std::unique_ptr<LogReader>>& logs) {
  json data;
  std::map<std::string, int> names;
  for (const auto& log : logs) {
    json one = data_of(*log);
    const auto name = one["name"].get<std::string>();
    if (const int before = names[name]++; before > 0) {
      one["name"] = name + " " + std::to_string(before + 1);
    }
    if (data.is_null()) {
      data = std::move(one);
      data["others"] = json::array();
    } else {
      data["others"].push_back(std::move(one));
    }
  }
  return script_text(data);
}

std::string report_page(const std::string& data, std::string* error) {
  return page_with_data("report", "the report page", data, error);
}

}  // namespace gaitd::cli
