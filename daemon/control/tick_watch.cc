// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/tick_watch.h"

#include <numeric>

#include "gaitd/sdk/layer_names.h"

namespace gaitd::daemon {
namespace {

constexpr auto kRelaxed = std::memory_order_relaxed;

void count(std::atomic<std::uint64_t>& counter) {
  counter.store(counter.load(kRelaxed) + 1, kRelaxed);
}

}  // namespace

const char* late_name(int late) {
  if (late == kLateWakeUp) return "wake_up";
  if (late < 0 || late > kLateWakeUp) return "rest of the tick";
  return sdk::kLayerNames[late].data();
}

void TickWatch::add(std::int64_t tick, const TickTimes& times, const Budgets& budgets) noexcept {
  int worst = -1;
  for (int i = 0; i < GAITD_LAYER_COUNT; ++i) {
    layers_[i].times.add(times.layer_us[i]);
    layers_[i].budget.store(budgets[i], kRelaxed);
    if (times.layer_us[i] <= budgets[i]) continue;
    count(layers_[i].over);
    const bool worse =
        worst < 0 || times.layer_us[i] * budgets[worst] > times.layer_us[worst] * budgets[i];
    if (worse) worst = i;
  }
  total_.add(times.total_us);
  wake_up_.add(times.jitter_us);
  tick_ = tick;
  last_ = times;
  last_budgets_ = budgets;
  if (worst >= 0 && overruns_.load(kRelaxed) == 0) {
    blame(worst, tick, times.layer_us[worst], budgets[worst]);
  }
}

// The part that took most beyond what it may: layers beyond their budgets, a wake-up beyond nothing
// at all, the rest beyond what the budgets leave of the period.
int TickWatch::overrun() noexcept {
  count(overruns_);
  const double layers = std::accumulate(last_.layer_us.begin(), last_.layer_us.end(), 0.0);
  const double budgets = std::accumulate(last_budgets_.begin(), last_budgets_.end(), 0.0);
  const double left = period_us_ > budgets ? period_us_ - budgets : 0.0;
  int what = kLateRest;
  double time = last_.total_us - layers;
  double budget = left;
  const auto consider = [&](int candidate, double took, double may) {
    if (took - may <= time - budget) return;
    what = candidate;
    time = took;
    budget = may;
  };
  for (int i = 0; i < GAITD_LAYER_COUNT; ++i) consider(i, last_.layer_us[i], last_budgets_[i]);
  consider(kLateWakeUp, last_.jitter_us, 0.0);
  blame(what, tick_, time, budget);
  return what;
}

void TickWatch::blame(int what, std::int64_t tick, double time, double budget) noexcept {
  late_tick_.store(tick, kRelaxed);
  late_time_.store(time, kRelaxed);
  late_budget_.store(budget, kRelaxed);
  late_.store(what, std::memory_order_release);
}

TickWatch::Report TickWatch::report() const noexcept {
  Report r;
  for (int i = 0; i < GAITD_LAYER_COUNT; ++i) {
    r.layers[i] = {layers_[i].times.figures(), layers_[i].budget.load(kRelaxed),
                   layers_[i].over.load(kRelaxed)};
  }
  r.total = total_.figures();
  r.wake_up = wake_up_.figures();
  r.overruns = overruns_.load(kRelaxed);
  r.late.what = late_.load(std::memory_order_acquire);
  r.late.tick = late_tick_.load(kRelaxed);
  r.late.time = late_time_.load(kRelaxed);
  r.late.budget = late_budget_.load(kRelaxed);
  return r;
}

}  // namespace gaitd::daemon
