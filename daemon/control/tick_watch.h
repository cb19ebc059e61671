// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "daemon/control/tick_data.h"
#include "daemon/control/time_histogram.h"

namespace gaitd::daemon {

// What was late: a layer (GAITD_LAYER_*), or one of these.
inline constexpr int kLateWakeUp = GAITD_LAYER_COUNT;    // the control thread was woken late
inline constexpr int kLateRest = GAITD_LAYER_COUNT + 1;  // backend, gait machine, objectives, log

// The name of a layer, "wake_up" or "rest of the tick".
const char* late_name(int late);

// Where the time of the ticks goes: histograms of the layers, of the whole tick and of the
// wake-ups, how often a layer was over its budget, and what was to blame when a tick was not done
// in time. The control thread adds, any thread reads; neither waits. Wall times are for reports:
// nothing here acts on the robot.
class TickWatch {
 public:
  using Budgets = std::array<double, GAITD_LAYER_COUNT>;

  explicit TickWatch(double period) : period_us_(1e6 * period) {}

  // ---- Control thread. [rt]

  // After a tick; `budgets`, µs, are those of the layers in use.
  void add(std::int64_t tick, const TickTimes& times, const Budgets& budgets) noexcept;
  // The next tick could not begin when it should. What was to blame in the last tick that was
  // added.
  int overrun() noexcept;

  // ---- Any thread.

  struct Layer {
    TimeHistogram::Figures time;
    double budget = 0.0;     // µs, of the variant in use
    std::uint64_t over = 0;  // ticks over it
  };
  struct Late {
    int what = -1;  // -1: nothing ever was
    std::int64_t tick = 0;
    double time = 0.0;    // µs
    double budget = 0.0;  // µs
  };
  struct Report {
    std::array<Layer, GAITD_LAYER_COUNT> layers;
    TimeHistogram::Figures total;
    TimeHistogram::Figures wake_up;  // lateness
    std::uint64_t overruns = 0;
    Late late;  // to blame for the last overrun; without one: the last layer over its budget
  };
  Report report() const noexcept;

 private:
  void blame(int what, std::int64_t tick, double time, double budget) noexcept;

  struct Entry {
    TimeHistogram times;
    std::atomic<double> budget{0.0};
    std::atomic<std::uint64_t> over{0};
  };
  const double period_us_;
  std::array<Entry, GAITD_LAYER_COUNT> layers_;
  TimeHistogram total_;
  TimeHistogram wake_up_;
  std::atomic<std::uint64_t> overruns_{0};
  // A reader may see them of two different ticks; they are for people.
  std::atomic<int> late_{-1};
  std::atomic<std::int64_t> late_tick_{0};
  std::atomic<double> late_time_{0.0};
  std::atomic<double> late_budget_{0.0};
  std::int64_t tick_ = 0;
  TickTimes last_;
  Budgets last_budgets_{};
};

}  // namespace gaitd::daemon
