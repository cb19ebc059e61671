// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "cli/doctor/log_checks.h"
#include "cli/doctor/reach.h"

namespace gaitd::doctor {
namespace {

constexpr double kMissed = 0.15;  // m, horizontally, when the swing is due

using Place = std::array<const daemon::Column*, 3>;

Place place(const LogCase& log, const std::string& prefix) {
  return {log.find(prefix + "x"), log.find(prefix + "y"), log.find(prefix + "z")};
}

bool complete(const Place& p) {
  return std::none_of(p.begin(), p.end(), [](const daemon::Column* c) { return c == nullptr; });
}

double horizontal(const Place& a, const Place& b, std::size_t i) {
  return std::hypot((*a[0])[i] - (*b[0])[i], (*a[1])[i] - (*b[1])[i]);
}

}  // namespace

Findings check_footsteps(const LogCase& log) {
  const GaitdModel* model = log.model();
  const daemon::Column* remaining = log.find("gait/time_remaining");
  const daemon::Column* index = log.find("gait/step_index");
  if (model == nullptr || remaining == nullptr || index == nullptr) return {};
  const Place foot[] = {place(log, "foot/left/"), place(log, "foot/right/")};
  const Place goal[] = {place(log, "footstep/left/"), place(log, "footstep/right/")};
  for (int k = 0; k < 2; ++k) {
    if (!complete(foot[k]) || !complete(goal[k])) return {};
  }
  const double length = leg_length(*model);
  const double reach = longest_step(length);
  std::vector<bool> too_far(log.run().ticks());
  std::vector<bool> missed(log.run().ticks());
  for (std::size_t i = 0; i < too_far.size(); ++i) {
    const int stance = log.support(i);
    if (!log.controlled(i) || !log.swinging(i) || stance < 0) continue;
    const int swing = 1 - stance;
    const double step = horizontal(goal[swing], foot[stance], i);
    const double height = std::abs((*goal[swing][2])[i] - (*foot[stance][2])[i]);
    too_far[i] = step > reach || height > 0.5 * length;
    missed[i] = (*remaining)[i] <= 0.0 && horizontal(goal[swing], foot[swing], i) > kMissed;
  }
  Findings findings;
  for (const bool far : {true, false}) {
    auto episode = last_episode(log, far ? too_far : missed, 0.01);
    if (!episode) continue;
    const std::size_t i = episode->begin;
    const int stance = log.support(i);
    const int swing = 1 - stance;
    const char* side = daemon::kSides[static_cast<std::size_t>(swing)];
    const std::string what =
        far ? format(
                  "the footstep of step %d lies %.2f m from the standing foot (%.2f m up or "
                  "down): legs of %.2f m reach about %.2f m",
                  static_cast<int>((*index)[i]), horizontal(goal[swing], foot[stance], i),
                  std::abs((*goal[swing][2])[i] - (*foot[stance][2])[i]), length, reach)
            : format("the %s foot was still %.2f m from its footstep when step %d was due", side,
                     horizontal(goal[swing], foot[swing], i), static_cast<int>((*index)[i]));
    findings.push_back(log_finding(
        log, "footstep", i, what,
        format(
            "the footsteps that were sent; gait.longest_step (%g CoM heights), gait.highest_step, "
            "gait.widest_step refuse those out of reach; a longer swing",
            log.setting("gait.longest_step", 0.85))));
  }
  return findings;
}

}  // namespace gaitd::doctor
