// SPDX-License-Identifier: Apache-2.0
#include "daemon/verdict/steps.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gaitd::daemon {

namespace {

constexpr double kFallenHeight = 0.6;  // of the height at the start
constexpr double kFallenTilt = 1.0;    // rad

constexpr double kAftermath = 2.0;  // s, after the control, in which a fall is one of the robot

bool is_set(double value, int bit) {
  return value >= 0.0 && (static_cast<std::uint64_t>(value) >> bit & 1u) != 0;
}

struct HeightSource {
  const Column* pelvis = nullptr;
  const Column* left = nullptr;
  const Column* right = nullptr;

  bool complete() const { return pelvis != nullptr && left != nullptr && right != nullptr; }
};

// Height of the pelvis above the lower foot; empty if the log does not tell. Pelvis and feet come
// from the same source: an error of the estimator's height cancels in the difference, which it
// would not between a true pelvis and estimated feet.
Column pelvis_height(const RunData& run) {
  HeightSource source = {run.find("truth/pelvis/z"), run.find("truth/foot/left/z"),
                         run.find("truth/foot/right/z")};
  if (!source.complete()) {
    source = {run.find("pelvis/z"), run.find("foot/left/z"), run.find("foot/right/z")};
  }
  Column height;
  if (!source.complete()) return height;
  for (std::size_t tick = 0; tick < run.ticks(); ++tick) {
    height.push_back((*source.pelvis)[tick] -
                     std::min((*source.left)[tick], (*source.right)[tick]));
  }
  return height;
}

// Ticks with a robot under control, and what becomes of it soon after: one that is laid down later,
// or has never stood, has not fallen unless the fault `fall` says so.
std::vector<bool> judged(const RunData& run) {
  std::vector<bool> ticks = run.controlled();
  double since = -std::numeric_limits<double>::infinity();  // s
  for (std::size_t tick = 0; tick < ticks.size(); ++tick) {
    if (ticks[tick]) since = run.time()[tick];
    ticks[tick] = run.time()[tick] - since <= kAftermath;
  }
  return ticks;
}

// The first tick at which `fallen` holds, if that is before the fall found so far.
template <class Predicate>
void find_first_tick(const RunData& run, const char* reason, const Predicate& fallen,
                     std::optional<Fall>* fall) {
  const std::size_t end = *fall ? (*fall)->tick : run.ticks();
  for (std::size_t tick = 0; tick < end; ++tick) {
    if (!fallen(tick)) continue;
    *fall = Fall{tick, reason};
    return;
  }
}

}  // namespace

std::optional<Fall> find_fall(const RunData& run) {
  std::optional<Fall> fall;
  const std::vector<bool> may_fall = judged(run);
  const auto first = std::find(may_fall.begin(), may_fall.end(), true);
  const Column height = pelvis_height(run);
  if (!height.empty() && first != may_fall.end()) {
    // Written so that what is not a number counts as fallen.
    const double least = kFallenHeight * height[static_cast<std::size_t>(first - may_fall.begin())];
    find_first_tick(
        run, "pelvis below 60 % of its height at the start",
        [&](std::size_t tick) { return may_fall[tick] && !(height[tick] >= least); }, &fall);
  }
  const Column* roll = run.find_first({"truth/pelvis/roll", "pelvis/roll"});
  const Column* pitch = run.find_first({"truth/pelvis/pitch", "pelvis/pitch"});
  if (roll != nullptr && pitch != nullptr) {
    const double upright = std::cos(kFallenTilt);
    find_first_tick(
        run, "pelvis tilted by more than 1 rad",
        [&](std::size_t tick) {
          return may_fall[tick] && !(std::cos((*roll)[tick]) * std::cos((*pitch)[tick]) >= upright);
        },
        &fall);
  }
  const Column* faults = run.find("safety/faults");
  if (faults != nullptr && run.robot().fall_bit) {
    find_first_tick(
        run, "fault: fall",
        [&](std::size_t tick) { return is_set((*faults)[tick], *run.robot().fall_bit); }, &fall);
  }
  return fall;
}

std::vector<Step> find_steps(const RunData& run, const std::optional<Fall>& fall) {
  const Column* index = run.find("gait/step_index");
  const Column* closing = run.find("gait/closing");
  const Column* toe_off = run.find("toe_off/active");
  const std::vector<Phase>& phase = run.phase();
  const std::size_t last = fall ? fall->tick : run.ticks();
  std::vector<Step> steps;
  for (std::size_t tick = 0; tick < last; ++tick) {
    if (phase[tick] != Phase::kSwing) continue;
    const bool swung_before = tick > 0 && phase[tick - 1] == Phase::kSwing;
    const bool other_step = index != nullptr && tick > 0 && (*index)[tick] != (*index)[tick - 1];
    if (!swung_before || other_step) {
      if (swung_before) steps.back().completed = true;
      const bool from_transfer = tick > 0 && phase[tick - 1] == Phase::kTransfer;
      steps.push_back(
          {.begin = tick,
           .end = tick,
           .toe_off = from_transfer && toe_off != nullptr && (*toe_off)[tick - 1] == 1.0});
    }
    Step& step = steps.back();
    step.end = tick + 1;
    step.closing = step.closing || (closing != nullptr && (*closing)[tick] == 1.0);
    const bool touched_down =
        step.end < last && phase[step.end] != Phase::kSwing && phase[step.end] != Phase::kUnknown;
    step.completed = step.completed || touched_down;
  }
  return steps;
}

}  // namespace gaitd::daemon
