// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Core>

#include "cli/doctor/log_checks.h"

namespace gaitd::doctor {
namespace {

constexpr double kLeastPull = 0.5;  // s
constexpr double kShows = 0.1;      // of the force

}  // namespace

Findings check_pull(const LogCase& log) {
  const daemon::Column* pulled = log.find("external/pulled");
  const daemon::Column* x = log.find("external/force/x");
  const daemon::Column* y = log.find("external/force/y");
  if (pulled == nullptr || x == nullptr || y == nullptr) return {};
  std::vector<bool> wrong(pulled->size());
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    wrong[i] = log.controlled(i) && (*pulled)[i] != 0.0;
  }
  auto episode = last_episode(log, wrong, kLeastPull);
  if (!episode) return {};
  Eigen::Vector2d force = Eigen::Vector2d::Zero();
  for (std::size_t i = episode->begin; i < episode->end; ++i)
    force += Eigen::Vector2d((*x)[i], (*y)[i]);
  const auto ticks = static_cast<double>(episode->end - episode->begin);
  force /= ticks;
  // It is counted on later than it shows.
  const auto shows = [&](std::size_t i) {
    return force.dot(Eigen::Vector2d((*x)[i], (*y)[i])) > kShows * force.squaredNorm();
  };
  while (episode->begin > 0 && log.controlled(episode->begin - 1) && shows(episode->begin - 1)) {
    --episode->begin;
  }
  return {log_finding(
      log, "pull", episode->begin,
      format("something pulled at the robot, with about %.0f N towards %s for %.1f s; it leaned "
             "against it",
             force.norm(), direction(force).c_str(), ticks * log.period()),
      "if nothing did: `gaitctl tare` while the robot stands on its own")};
}

}  // namespace gaitd::doctor
