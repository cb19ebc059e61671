// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <optional>
#include <vector>

#include "cli/doctor/log_checks.h"

namespace gaitd::doctor {
namespace {

constexpr double kLeastLoad = 0.8;    // s
constexpr double kLeastMass = 0.005;  // of that of the robot
constexpr double kNext = 0.2;         // s: the force is judged once it has settled

// The last in which the robot was under control and `wrong` was not 0.
std::optional<Episode> episode_of(const LogCase& log, const daemon::Column& wrong) {
  std::vector<bool> holds(wrong.size());
  for (std::size_t i = 0; i < holds.size(); ++i) holds[i] = log.controlled(i) && wrong[i] != 0.0;
  return last_episode(log, holds, kLeastLoad);
}

// Standing or walking, however heavy: the mean of what does not fit, at its largest.
Findings check_surplus(const LogCase& log, const GaitdModel& model) {
  const daemon::Column* surplus = log.find("external/surplus");
  const daemon::Column* misjudged = log.find("external/misjudged");
  if (surplus == nullptr || misjudged == nullptr) return {};
  const auto episode = episode_of(log, *misjudged);
  if (!episode) return {};
  double force = 0.0;
  for (std::size_t i = episode->begin; i < episode->end; ++i) {
    if (std::abs((*surplus)[i]) > std::abs(force)) force = (*surplus)[i];
  }
  const double mass = force / model.gravity;
  Finding finding =
      log_finding(log, "load", episode->begin,
                  format("the robot was %.1f kg %s than it was known to be, for %.1f s",
                         std::abs(mass), mass > 0.0 ? "heavier" : "lighter",
                         static_cast<double>(episode->end - episode->begin) * log.period()),
                  "what `payload set` said; what was put on or taken off in the walk; a rope");
  if (std::abs(mass) < 0.1 * model.total_mass) finding.severity = Severity::kWarning;
  return {finding};
}

}  // namespace

Findings check_load(const LogCase& log) {
  const daemon::Column* load = log.find("external/load");
  const GaitdModel* model = log.model();
  if (load == nullptr || model == nullptr) return {};
  const auto episode = episode_of(log, *load);
  if (!episode) return check_surplus(log, *model);
  double sum = 0.0;
  std::size_t count = 0;
  const auto settled = episode->begin + static_cast<std::size_t>(kNext / log.period());
  for (std::size_t i = settled; i < episode->end; ++i, ++count) sum += (*load)[i];
  const double mass = -sum / static_cast<double>(count) / model->gravity;
  if (!(std::abs(mass) > kLeastMass * model->total_mass)) return check_surplus(log, *model);
  Finding finding = log_finding(
      log, "load", episode->begin,
      format("%.1f kg were %s the standing robot, which did not know of them for %.1f s",
             std::abs(mass), mass > 0.0 ? "put on" : "taken off",
             static_cast<double>(episode->end - episode->begin) * log.period()),
      "`gaitctl payload estimate` while it stands, or `payload set` and `payload clear`; "
      "if nothing was: `gaitctl tare`");
  if (std::abs(mass) < 0.1 * model->total_mass) finding.severity = Severity::kWarning;
  return {finding};
}

}  // namespace gaitd::doctor
