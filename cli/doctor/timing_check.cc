// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "cli/doctor/log_checks.h"

namespace gaitd::doctor {
namespace {

constexpr int kFewest = 3;  // late ticks

}  // namespace

// In lockstep wall time never acts, so that no tick is late.
Findings check_timing(const LogCase& log) {
  const daemon::Column* total = log.find("tick/total_us");
  const daemon::Column* jitter = log.find("tick/jitter_us");
  if (!log.realtime() || total == nullptr || jitter == nullptr) return {};
  const double period_us = 1e6 * log.period();
  std::vector<bool> wrong(total->size());
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    wrong[i] = log.controlled(i) && ((*total)[i] > period_us || (*jitter)[i] > period_us);
  }
  const auto episode = last_episode(log, wrong, 0.0, 0.2);
  if (!episode) return {};
  int late = 0;
  std::size_t worst = episode->begin;
  for (std::size_t i = episode->begin; i < episode->end; ++i) {
    if (!wrong[i]) continue;
    ++late;
    if ((*total)[i] + (*jitter)[i] > (*total)[worst] + (*jitter)[worst]) worst = i;
  }
  if (late < kFewest) return {};
  const char* slowest = "waking up";
  double longest = (*jitter)[worst];
  for (const char* layer : {"estimator", "planner", "adjuster", "toe_off", "wbc", "tasks"}) {
    const daemon::Column* time = log.find("tick/" + std::string(layer) + "_us");
    if (time == nullptr || (*time)[worst] <= longest) continue;
    longest = (*time)[worst];
    slowest = layer;
  }
  return {log_finding(
      log, "timing", episode->begin,
      format("%d of %zu ticks were late: the worst took %.2f ms and began %.2f ms late, with a "
             "period of %.2f ms; most of it went to %s (%.2f ms)",
             late, episode->end - episode->begin, 1e-3 * (*total)[worst], 1e-3 * (*jitter)[worst],
             1e-3 * period_us, slowest, 1e-3 * longest),
      "period, realtime.priority, realtime.affinity, realtime.lock_memory; `gaitctl doctor` looks "
      "at the machine")};
}

}  // namespace gaitd::doctor
