// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/metadata.h"

#include <cmath>

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
  (*metadata)["joints"] = joints.dump();
  (*metadata)["legs"] = legs.dump();
  (*metadata)["fault_bits"] = faults.dump();
}

json status_of(const Telemetry& telemetry) {
  std::vector<double> values;
  json status;
  if (!telemetry.latest(values)) {
    status["tick"] = nullptr;
    return status;
  }
  const SignalTable& table = telemetry.table();
  for (std::size_t i = 0; i < table.size() && i < values.size(); ++i) {
    const SignalDescription& signal = table[i];
    if (signal.name.starts_with("truth/") || signal.name.starts_with("joint/")) continue;
    json value = nullptr;
    const auto index = static_cast<std::size_t>(std::max(0.0, values[i]));
    switch (signal.kind) {
      case SignalDescription::Kind::kReal:
        if (std::isfinite(values[i])) value = values[i];
        break;
      case SignalDescription::Kind::kInteger:
        value = static_cast<std::int64_t>(values[i]);
        break;
      case SignalDescription::Kind::kBoolean:
        value = values[i] != 0.0;
        break;
      case SignalDescription::Kind::kEnumeration:
        if (index < signal.words.size()) value = signal.words[index];
        break;
    }
    // A name may be a prefix of another one: "icp/x" and "icp/desired/x" nest, nothing else does.
    status[json::json_pointer("/" + signal.name)] = value;
  }
  json faults = json::array();
  const auto bits = status.value(json::json_pointer("/safety/faults"), std::int64_t{0});
  for (std::size_t i = 0; i < kFaultNames.size(); ++i) {
    if ((bits >> i & 1) != 0) faults.push_back(kFaultNames[i]);
  }
  status["safety"]["faults"] = faults;
  return status;
}

}  // namespace gaitd::daemon
