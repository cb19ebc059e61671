// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/metadata.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/control/tick_data.h"

namespace gaitd::daemon {

using nlohmann::json;

void add_robot_metadata(const GaitdModel& model, LogMetadata* metadata) {
  json joints = json::array();
  for (int i = 0; i < model.joint_count; ++i) {
    joints.push_back(
        {{"name", model.joints[i].name}, {"effort_limit", model.joints[i].effort_limit}});
  }
  json legs;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdLeg& leg = model.legs[side];
    json names = json::array();
    for (int i = 0; i < leg.joint_count; ++i) names.push_back(model.joints[leg.joints[i]].name);
    legs[side == GAITD_LEFT ? "left" : "right"] = {{"knee", model.joints[leg.knee].name},
                                                   {"knee_bend_sign", leg.knee_bend_sign},
                                                   {"joints", names}};
  }
  json faults;
  for (std::size_t i = 0; i < kFaultNames.size(); ++i) faults[kFaultNames[i]] = i;
  json soles;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdFoot& foot = model.feet[side];
    json corners = json::array();
    for (int i = 0; i < foot.point_count; ++i) {
      corners.push_back({foot.points[i][0], foot.points[i][1]});
    }
    soles[side == GAITD_LEFT ? "left" : "right"] = corners;
  }
  (*metadata)["pelvis"] = model.bodies[0].name;
  (*metadata)["soles"] = soles.dump();
  (*metadata)["joints"] = joints.dump();
  (*metadata)["legs"] = legs.dump();
  (*metadata)["fault_bits"] = faults.dump();
}

namespace {

std::string content(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

void add_replay_metadata(const Robot& robot, json start, LogMetadata* metadata) {
  start["robot_file"] = robot.file;
  (*metadata)["replay"] = start.dump();
  (*metadata)["robot_yaml"] = content(robot.file);
  (*metadata)["robot_urdf"] = content(robot.urdf);
  if (!robot.calibration_file.empty()) {
    (*metadata)["robot_calibration"] = content(robot.calibration_file);
  }
}

namespace {

// A signal as people read it; null if it is not there or not finite.
json signal_value(const SignalTable& table, const std::vector<double>& values,
                  std::string_view name) {
  for (std::size_t i = 0; i < table.size() && i < values.size(); ++i) {
    const SignalDescription& signal = table[i];
    if (signal.name != name || !std::isfinite(values[i])) continue;
    switch (signal.kind) {
      case SignalDescription::Kind::kReal:
        return values[i];
      case SignalDescription::Kind::kInteger:
        return static_cast<std::int64_t>(values[i]);
      case SignalDescription::Kind::kBoolean:
        return values[i] != 0.0;
      case SignalDescription::Kind::kEnumeration:
        const auto index = static_cast<std::size_t>(std::max(0.0, values[i]));
        return index < signal.words.size() ? json(signal.words[index]) : json();
    }
  }
  return nullptr;
}

}  // namespace

json status_of(const Telemetry& telemetry) {
  std::vector<double> values;
  json status;
  const bool ticked = telemetry.latest(values);
  if (!ticked) values.clear();
  const auto get = [&](const std::string& name) {
    return signal_value(telemetry.table(), values, name);
  };
  for (const char* name : {"time", "tick"}) status[name] = get(name);
  status["state"] = get("safety/state");
  for (const char* name : {"mode", "phase", "support", "step_index", "footsteps_ahead", "paused"}) {
    status[name] = get(std::string("gait/") + name);
  }
  const auto pose = [&](const std::string& frame) {
    json axes;
    for (const char* axis : {"x", "y", "z", "yaw"}) axes[axis] = get(frame + "/" + axis);
    return axes;
  };
  status["pelvis"] = pose("pelvis");
  status["feet"] = {{"left", pose("foot/left")}, {"right", pose("foot/right")}};
  status["faults"] = json::array();
  const json bits = get("safety/faults");
  for (std::size_t i = 0; bits.is_number() && i < kFaultNames.size(); ++i) {
    if ((bits.get<std::int64_t>() >> i & 1) != 0) status["faults"].push_back(kFaultNames[i]);
  }
  status["joints_dropped"] = get("safety/joints_dropped");
  const json state = status["state"];
  const bool controlled = state == "standing" || state == "walking" || state == "stopping";
  const json icp[] = {get("icp/x"), get("icp/y"), get("icp/desired/x"), get("icp/desired/y")};
  const bool measured = controlled && std::all_of(std::begin(icp), std::end(icp),
                                                  [](const json& v) { return v.is_number(); });
  status["icp_error"] = measured ? json(std::hypot(icp[0].get<double>() - icp[2].get<double>(),
                                                   icp[1].get<double>() - icp[3].get<double>()))
                                 : json();
  // Of the last tick, and the longest within a second or two.
  const std::vector<double> longest = telemetry.recent_maxima();
  const auto get_longest = [&](const std::string& name) {
    return signal_value(telemetry.table(), longest, name);
  };
  status["tick_us"] = get("tick/total_us");
  status["tick_longest_us"] = get_longest("tick/total_us");
  constexpr const char* kLayerTimes[] = {"estimator_us", "planner_us", "adjuster_us", "toe_off_us",
                                         "wbc_us"};
  for (int layer = 0; layer < GAITD_LAYER_COUNT; ++layer) {
    const std::string signal = std::string("tick/") + kLayerTimes[layer];
    status["layers"].push_back({{"time_us", get(signal)}, {"longest_us", get_longest(signal)}});
  }
  return status;
}

void add_times(const TickWatch::Report& report, const RealtimeReport& realtime, json* status) {
  const auto add_figures = [](const TimeHistogram::Figures& f, json* to) {
    (*to)["median_us"] = f.count == 0 ? json() : json(f.median);
    (*to)["p99_us"] = f.count == 0 ? json() : json(f.p99);
    (*to)["max_us"] = f.count == 0 ? json() : json(f.max);
  };
  for (int layer = 0; layer < GAITD_LAYER_COUNT; ++layer) {
    json& entry = (*status)["layers"][layer];
    add_figures(report.layers[layer].time, &entry);
    entry["budget_us"] = report.layers[layer].budget;
    entry["over_budget"] = report.layers[layer].over;
  }
  add_figures(report.total, &(*status)["whole_tick"]);
  add_figures(report.wake_up, &(*status)["wake_up"]);
  (*status)["overruns"] = report.overruns;
  const TickWatch::Late& late = report.late;
  (*status)["late"] = late.what < 0 ? json()
                                    : json({{"what", late_name(late.what)},
                                            {"tick", late.tick},
                                            {"time_us", late.time},
                                            {"budget_us", late.budget}});
  (*status)["realtime"] = {{"got", realtime.got}, {"degraded", realtime.degraded}};
}

}  // namespace gaitd::daemon
