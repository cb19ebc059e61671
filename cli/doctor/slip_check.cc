// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include "cli/doctor/log_checks.h"

namespace gaitd::doctor {
namespace {

constexpr double kSlipped = 0.015;  // m
constexpr double kBegan = 0.003;    // m
constexpr double kOnFoot = 0.2;     // of the weight

struct Slip {
  Episode episode;
  std::string foot;
};

// The simulation tells how far the foot went; the signal begins again at every touchdown.
std::optional<Slip> true_slip(const LogCase& log) {
  std::optional<Slip> first;
  for (const char* side : daemon::kSides) {
    const daemon::Column* slip = log.find("truth/foot/" + std::string(side) + "/slip");
    if (slip == nullptr) continue;
    std::vector<bool> wrong(slip->size());
    for (std::size_t i = 0; i < wrong.size(); ++i) wrong[i] = (*slip)[i] > kSlipped;
    auto episode = last_episode(log, wrong, 0.0);
    if (!episode) continue;
    while (episode->begin > 0 && (*slip)[episode->begin] > kBegan) --episode->begin;
    if (!first || episode->begin < first->episode.begin) first = {*episode, side};
  }
  return first;
}

// Else the joints tell whether two feet that both carry load move apart.
std::optional<Slip> measured_slip(const LogCase& log) {
  const daemon::Column* x[] = {log.find("foot/left/x"), log.find("foot/right/x")};
  const daemon::Column* y[] = {log.find("foot/left/y"), log.find("foot/right/y")};
  const daemon::Column* f[] = {log.find("foot/left/force/z"), log.find("foot/right/force/z")};
  const daemon::Column* toe = log.find("toe_off/active");
  const GaitdModel* model = log.model();
  for (int k = 0; k < 2; ++k) {
    if (x[k] == nullptr || y[k] == nullptr || f[k] == nullptr) return std::nullopt;
  }
  if (toe == nullptr || model == nullptr) return std::nullopt;
  const double load = kOnFoot * model->total_mass * model->gravity;
  std::vector<bool> wrong(x[0]->size());
  std::optional<double> reference;
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    const bool both =
        log.controlled(i) && std::min((*f[0])[i], (*f[1])[i]) > load && (*toe)[i] == 0.0;
    const double distance = std::hypot((*x[0])[i] - (*x[1])[i], (*y[0])[i] - (*y[1])[i]);
    if (!both) reference.reset();
    if (both && !reference) reference = distance;
    wrong[i] = both && std::abs(distance - *reference) > kSlipped;
  }
  const auto episode = last_episode(log, wrong, 0.0);
  return episode ? std::optional<Slip>({*episode, "one"}) : std::nullopt;
}

// Sideways force over load of that foot while it began to slide: what the ground gave.
double grip(const LogCase& log, const Slip& slip) {
  double most = 0.0;
  const std::size_t end = std::min(log.end(), slip.episode.begin + 100);
  for (const char* side : daemon::kSides) {
    if (slip.foot != "one" && slip.foot != side) continue;
    const std::string force = "foot/" + std::string(side) + "/force/";
    const daemon::Column* fx = log.find(force + "x");
    const daemon::Column* fy = log.find(force + "y");
    const daemon::Column* fz = log.find(force + "z");
    const GaitdModel* model = log.model();
    if (fx == nullptr || fy == nullptr || fz == nullptr || model == nullptr) continue;
    for (std::size_t i = slip.episode.begin; i < end; ++i) {
      if ((*fz)[i] < kOnFoot * model->total_mass * model->gravity) continue;
      most = std::max(most, std::hypot((*fx)[i], (*fy)[i]) / (*fz)[i]);
    }
  }
  return most;
}

}  // namespace

Findings check_slip(const LogCase& log) {
  const bool truth = log.find("truth/foot/left/slip") != nullptr;
  const auto slip = truth ? true_slip(log) : measured_slip(log);
  if (!slip) return {};
  const double friction = log.setting("objectives.friction", 0.7);
  const double ratio = grip(log, *slip);
  std::string what =
      format("%s foot slid on the ground by more than %.0f mm",
             slip->foot == "one" ? "one" : ("the " + slip->foot).c_str(), 1e3 * kSlipped);
  if (ratio > 0.0) {
    what += format(
        "; the ground gave at most %.2f of the load sideways, the controller counts on "
        "%.2f",
        ratio, friction);
  }
  return {log_finding(log, "slip", slip->episode.begin, what,
                      format("objectives.friction (%g): not more than the ground gives; shorter "
                             "and slower steps ask for less",
                             friction))};
}

}  // namespace gaitd::doctor
