// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include "cli/doctor/log_checks.h"

namespace gaitd::doctor {
namespace {

constexpr double kAtLimit = 0.999;     // of the limit
constexpr double kLeastTorque = 0.02;  // s

}  // namespace

Findings check_torques(const LogCase& log) {
  const double ratio = log.setting("limits.torque_ratio", 1.0);
  const double scale = log.setting("whole_body_controller.torque_scale", 1.0);
  const double share = std::min(ratio, scale);
  std::vector<bool> wrong(log.run().ticks());
  std::map<std::string, std::vector<bool>> joints;
  for (const daemon::LegDescription& leg : log.run().robot().legs) {
    for (const std::string& joint : leg.joints) {
      const daemon::Column* torque = log.find("joint/" + joint + "/torque_desired");
      const auto limit = log.run().robot().effort_limits.find(joint);
      if (torque == nullptr || limit == log.run().robot().effort_limits.end()) continue;
      std::vector<bool>& at_limit = joints[joint];
      at_limit.resize(torque->size());
      for (std::size_t i = 0; i < torque->size(); ++i) {
        at_limit[i] =
            log.controlled(i) && std::abs((*torque)[i]) >= kAtLimit * share * limit->second;
        wrong[i] = wrong[i] || at_limit[i];
      }
    }
  }
  const auto episode = last_episode(log, wrong, kLeastTorque);
  if (!episode) return {};
  std::string worst;
  long most = 0;
  for (const auto& [joint, at_limit] : joints) {
    const auto begin = at_limit.begin() + static_cast<long>(episode->begin);
    const long count = std::count(begin, at_limit.begin() + static_cast<long>(episode->end), true);
    if (count > most) {
      most = count;
      worst = joint;
    }
  }
  const double effort = log.run().robot().effort_limits.at(worst);
  return {log_finding(
      log, "torque", episode->begin,
      format("leg joints were at their torque limits, most of all %s: at %.4g N m for %.2f s",
             worst.c_str(), share * effort, static_cast<double>(most) * log.period()),
      format("limits.torque_ratio (%g), whole_body_controller.torque_scale (%g), effort of the "
             "joint in the URDF (%.4g N m); or ask for less: shorter, lower, slower steps",
             ratio, scale, effort))};
}

}  // namespace gaitd::doctor
