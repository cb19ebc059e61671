// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/status_report.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <string_view>
#include <vector>

#include "daemon/control/signals.h"
#include "daemon/control/state_text.h"
#include "daemon/control/tick_data.h"
#include "daemon/host/instance.h"
#include "daemon/host/layers.h"

namespace gaitd::daemon {

using nlohmann::json;

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

// What the robot carries.
json payload_of(const SignalTable& table, const std::vector<double>& values) {
  const auto get = [&](const std::string& name) {
    return signal_value(table, values, "payload/" + name);
  };
  const auto vector = [&](const std::string& of) {
    return json::array({get(of + "/x"), get(of + "/y"), get(of + "/z")});
  };
  const int outcome = find_signal(table, "payload/outcome");
  const bool known = outcome >= 0 && static_cast<std::size_t>(outcome) < values.size();
  json payload = {{"mass", get("mass")},
                  {"estimating", get("estimating")},
                  {"outcome", get("outcome")},
                  {"what", known ? json(outcome_text(static_cast<int>(values[outcome]))) : json()},
                  {"loads", json::array()}};
  for (int i = 0; i < GAITD_MAX_LOADS; ++i) {
    const std::string slot = std::to_string(i);
    const json link = get(slot + "/link");
    if (!link.is_string() || link == "none") continue;
    payload["loads"].push_back(
        {{"link", link},
         {"mass", get(slot + "/mass")},
         {"com", vector(slot + "/com")},
         {"uncertainty", link == get("weighed") ? vector("uncertainty") : json()}});
  }
  return payload;
}

// Of the newest tick that telemetry has seen.
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
  const auto velocity = [&](const std::string& of) {
    json axes;
    for (const char* axis : {"forward", "lateral", "turn"}) axes[axis] = get(of + "/" + axis);
    return axes;
  };
  const bool driven = get("drive/active") == true;
  status["drive"] =
      driven ? json{{"target", velocity("drive/target")}, {"step", velocity("drive/step")}}
             : json();
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
  status["icp_margin"] = controlled ? get("icp/margin") : json();
  const auto vector = [&](const std::string& of) {
    return json::array({get(of + "/x"), get(of + "/y"), get(of + "/z")});
  };
  status["handholds"] = json::object();
  for (const std::string hand : {"left", "right"}) {
    const std::string of = "handhold/" + hand;
    if (get(of + "/state").is_null()) continue;
    status["handholds"][hand] = {{"state", get(of + "/state")},
                                 {"force", vector(of + "/force_desired")},
                                 {"force_max", get(of + "/force_max")}};
  }
  status["external"] = get("external/tared") == true ? json{{"force", vector("external/force")},
                                                            {"moment", vector("external/moment")},
                                                            {"pulled", get("external/pulled")}}
                                                     : json();
  status["payload"] = payload_of(telemetry.table(), values);
  // Of the last tick, and the longest within a second or two.
  const std::vector<double> longest = telemetry.recent_maxima();
  const auto get_longest = [&](const std::string& name) {
    return signal_value(telemetry.table(), longest, name);
  };
  status["tick_us"] = get("tick/total_us");
  status["tick_longest_us"] = get_longest("tick/total_us");
  for (int layer = 0; layer < GAITD_LAYER_COUNT; ++layer) {
    const std::string signal = std::string("tick/") + kLayerTimes[layer];
    status["layers"].push_back({{"time_us", get(signal)}, {"longest_us", get_longest(signal)}});
  }
  return status;
}

// Where the time of the ticks went since the start, and what of real time there is.
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

}  // namespace

void show_estop(const EstopFlag& estop, json* status) {
  const std::uint64_t asked = estop.asked();
  if (asked == 0) return;
  const bool taken = estop.acted_on(asked);
  const json& tick = (*status)["tick"];
  if (taken && tick.is_number() && tick.get<std::int64_t>() >= estop.tick()) return;
  const char* const name = kFaultNames[std::countr_zero(std::uint32_t{kFaultEstop})];
  json& faults = (*status)["faults"];
  if (std::find(faults.begin(), faults.end(), name) == faults.end()) faults.push_back(name);
  if (taken) (*status)["state"] = kSafetyStateNames[static_cast<std::size_t>(SafetyState::kFault)];
}

void StatusReport::set_realtime(const RealtimeReport& realtime) {
  const std::scoped_lock lock(realtime_mutex_);
  realtime_ = realtime;
}

json StatusReport::status() const {
  json s = status_of(*sources_.telemetry);
  show_estop(*sources_.estop, &s);
  s.update(sources_.constants);
  for (int layer = 0; layer < GAITD_LAYER_COUNT; ++layer) {
    s["layers"][layer]["layer"] = layer_name(layer);
    s["layers"][layer]["variant"] = sources_.swaps->variant(layer);
  }
  {
    const std::scoped_lock lock(realtime_mutex_);
    add_times(sources_.watch->report(), realtime_, &s);
  }
  s["health"] = health();
  s["log"] = log();
  add_age(&s);
  return s;
}

// What a robot says of itself; null for a simulation.
json StatusReport::health() const {
  const GaitdBackendInstance& backend = sources_.backend;
  GaitdHealth h{};
  if (backend.vtable->health == nullptr ||
      contained([&] { return backend.vtable->health(backend.self, &h); }) != GAITD_OK) {
    return nullptr;
  }
  return {
      {"healthy", h.conditions == 0}, {"text", h.text},   {"late", h.late}, {"missing", h.missing},
      {"duplicate", h.duplicate},     {"stale", h.stale}, {"lost", h.lost}, {"unsent", h.unsent}};
}

json StatusReport::log() const {
  const Telemetry::LogStatus log = sources_.telemetry->log_status();
  return {{"file", log.file.empty() ? log.file : std::filesystem::absolute(log.file).string()},
          {"part", log.part},
          {"open", log.open},
          {"error", log.error},
          {"ticks", log.ticks},
          {"bytes", log.bytes},
          {"waiting", log.waiting},
          {"stalled", log.stalled},
          {"dropouts", sources_.telemetry->dropouts() + log.lost}};
}

// Whether what the status says still holds: a control loop that hangs says nothing any more.
void StatusReport::add_age(json* status) const {
  constexpr double kStale = 0.1;          // s
  constexpr double kStaleLockstep = 1.0;  // s, where a tick may take its time
  const ControlLoop* loop = loop_;
  const double age = loop == nullptr ? 0.0 : loop->pulse().age();
  const bool stale = age > (sources_.lockstep ? kStaleLockstep : kStale);
  const int inside = stale && loop != nullptr ? loop->inside() : -1;
  const auto goal = loop == nullptr ? std::nullopt : loop->goal();
  (*status)["goto"] = goal ? json{{"x", goal->x}, {"y", goal->y}} : json();
  (*status)["age"] = age;
  (*status)["stale"] = stale;
  (*status)["hangs_in"] = inside < 0 ? json() : json(layer_name(inside));
}

json StatusReport::joints() const {
  const SignalTable& table = sources_.telemetry->table();
  std::vector<double> values;
  const bool ticked = sources_.telemetry->latest(values);
  json joints = json::array();
  for (int i = 0; i < sources_.model->joint_count; ++i) {
    const GaitdJoint& joint = sources_.model->joints[i];
    json row = {{"name", joint.name},
                {"position_min", joint.position_min},
                {"position_max", joint.position_max}};
    for (const char* what : {"position", "velocity", "torque"}) {
      const int at = find_signal(table, std::string("joint/") + joint.name + "/" + what);
      row[what] = ticked && at >= 0 ? json(values[at]) : json();
    }
    joints.push_back(row);
  }
  return {{"joints", joints}};
}

}  // namespace gaitd::daemon
