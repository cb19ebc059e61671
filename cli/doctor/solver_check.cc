// SPDX-License-Identifier: Apache-2.0
#include <map>

#include "cli/doctor/log_checks.h"
#include "daemon/log/signal.h"

namespace gaitd::doctor {
namespace {

constexpr double kLeastUnsolved = 0.005;  // s without a solution

}  // namespace

Findings check_solver(const LogCase& log) {
  const daemon::Column* status = log.find("wbc/status");
  const int signal = daemon::find_signal(log.log().signals(), "wbc/status");
  if (status == nullptr || signal < 0) return {};
  std::vector<bool> wrong(status->size());
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    wrong[i] = log.controlled(i) && (*status)[i] != static_cast<double>(GAITD_WBC_SOLVED);
  }
  const auto episode = last_episode(log, wrong, kLeastUnsolved);
  if (!episode) return {};
  std::map<double, int> counts;
  int unsolved = 0;
  for (std::size_t i = episode->begin; i < episode->end; ++i) {
    if (!wrong[i]) continue;
    ++counts[(*status)[i]];
    ++unsolved;
  }
  std::string words;
  for (const auto& [value, count] : counts) {
    const auto& names = log.log().signals()[static_cast<std::size_t>(signal)].words;
    const auto index = static_cast<std::size_t>(value >= 0.0 ? value : 0.0);
    if (!words.empty()) words += ", ";
    words += (index < names.size() ? names[index] : std::string("?")) + " " +
             std::to_string(count) + "x";
  }
  return {log_finding(
      log, "solver", episode->begin,
      format("the whole-body controller found no solution in %d of %zu ticks (%s)", unsolved,
             episode->end - episode->begin, words.c_str()),
      format("whole_body_controller.max_iterations (%g) for max_iterations; for infeasible, what "
             "leaves no room: whole_body_controller.torque_scale (%g), "
             "whole_body_controller.joint_acceleration_limit (%g), joints at their limits",
             log.setting("whole_body_controller.max_iterations", 300.0),
             log.setting("whole_body_controller.torque_scale", 1.0),
             log.setting("whole_body_controller.joint_acceleration_limit", 2000.0)))};
}

}  // namespace gaitd::doctor
