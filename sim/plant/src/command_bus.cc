// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/command_bus.h"

#include <algorithm>
#include <cmath>

namespace gaitd::sim {

void CommandQueue::reset() {
  waiting_.clear();
  active_ = GaitdJointCommands{};
}

const GaitdJointCommands& CommandQueue::at(int64_t step) {
  std::size_t due = 0;
  while (due < waiting_.size() && waiting_[due].step <= step) ++due;
  if (due > 0) {
    active_ = waiting_[due - 1].commands;
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(due));
  }
  return active_;
}

CommandBus::CommandBus(double delay, const TimingFigures& timing, double time_step, uint64_t seed)
    : delay_(delay),
      time_step_(time_step),
      seed_(seed),
      timing_(timing),
      stream_(seed, RandomPurpose::kCommandTiming),
      queue_(steps(delay + timing_.latest())) {
  reset();
}

int64_t CommandBus::steps(double delay) const {
  return std::llround(std::max(0.0, delay) / time_step_);
}

void CommandBus::reset() {
  queue_.reset();
  newest_ = 0;
  stream_ = RandomStream(seed_, RandomPurpose::kCommandTiming);
  timing_.draw(&stream_);
}

void CommandBus::send(const GaitdJointCommands& commands, int64_t step) {
  const std::optional<double> late = timing_.next(&stream_);
  if (!late) return;
  newest_ = std::max(newest_, step + steps(delay_ + *late));
  queue_.push(commands, newest_);
}

}  // namespace gaitd::sim
