// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "cli/doctor/log_checks.h"

namespace gaitd::doctor {
namespace {

constexpr double kNoticed = 0.04;       // of the mass; force sensors are rarely better
constexpr double kWrong = 0.10;         // enough to make a robot fall
constexpr double kLeastStanding = 0.2;  // s of standing

}  // namespace

// Standing, the feet carry the weight; walking they do on average too.
Findings check_weight(const LogCase& log) {
  const daemon::Column* left = log.find("foot/left/force/z");
  const daemon::Column* right = log.find("foot/right/force/z");
  const GaitdModel* model = log.model();
  if (left == nullptr || right == nullptr || model == nullptr) return {};
  const daemon::Column* carried = log.find("payload/mass");
  double sum = 0.0;
  double known = 0.0;
  std::size_t count = 0;
  std::size_t first = 0;
  std::size_t last = 0;
  const auto least = static_cast<std::size_t>(kLeastStanding / log.period());
  for (std::size_t i = 0; i < log.end(); ++i) {
    const bool standing = log.controlled(i) && log.run().phase()[i] == daemon::Phase::kStand;
    if (!standing && count >= least) break;  // the first time that it stands
    if (!standing) continue;
    if (count++ == 0) first = i;
    last = i;
    sum += (*left)[i] + (*right)[i];
    known += carried == nullptr ? 0.0 : (*carried)[i];
  }
  if (count < least) return {};
  // What rises or sinks weighs more or less.
  const daemon::Column* velocity = log.find("com/velocity/z");
  const double seconds = log.time(last) - log.time(first);
  const double acceleration =
      velocity == nullptr ? 0.0 : ((*velocity)[last] - (*velocity)[first]) / seconds;
  const double measured =
      sum / static_cast<double>(count) / std::max(1.0, model->gravity + acceleration);
  const double mass = model->total_mass + known / static_cast<double>(count);
  const double error = measured / mass - 1.0;
  if (!(std::abs(error) > kNoticed)) return {};
  Finding finding =
      log_finding(log, "weight", first,
                  format("the feet carry %.1f kg where the model weighs %.1f kg, %.0f %% %s",
                         measured, mass, 100.0 * std::abs(error), error > 0.0 ? "more" : "less"),
                  "masses in the URDF, a load that it does not know of (gaitctl payload estimate), "
                  "or the calibration of the foot force sensors");
  if (std::abs(error) < kWrong) finding.severity = Severity::kWarning;
  return {finding};
}

}  // namespace gaitd::doctor
