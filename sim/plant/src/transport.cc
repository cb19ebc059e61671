// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/transport.h"

#include <algorithm>
#include <cmath>

namespace gaitd::sim {

Transport::Transport(const SensorFigures& figures, const Draw& delay, double time_step,
                     int steps_per_period, const SensorSeed& seed, uint64_t index)
    : arrival_stamps_(figures.arrival_stamps),
      delay_range_(delay),
      time_step_(time_step),
      steps_per_period_(steps_per_period),
      seed_(seed),
      index_(index),
      timing_({figures.jitter, figures.jitter_tail, figures.lost_frames, figures.lost_burst}),
      longest_(delay_steps(delay.high() + timing_.latest())),
      stream_(seed.episode, RandomPurpose::kTiming, index) {
  reset();
}

int Transport::delay_steps(double delay) const {
  return static_cast<int>(std::llround(std::max(0.0, delay) / time_step_));
}

void Transport::reset() {
  RandomStream robot(seed_.robot, RandomPurpose::kTiming, index_);
  delay_ = delay_range_.sample(&robot);
  timing_.draw(&robot);
  stream_ = seed_.go_on(robot, RandomPurpose::kTiming, index_);
  step_ = -delay_steps(delay_);
  arrival_ = 0;
}

bool Transport::advance(int64_t tick) {
  const std::optional<double> late = timing_.next(&stream_);
  if (!late) return false;
  const int64_t step = tick * steps_per_period_ - delay_steps(delay_ + *late);
  if (step <= step_) return false;
  step_ = step;
  arrival_ = tick;
  return true;
}

GaitdSignalInfo Transport::info(int64_t tick, double time) const {
  const int64_t stamp = arrival_stamps_ ? arrival_ * steps_per_period_ : step_;
  GaitdSignalInfo info{};
  info.age = static_cast<double>(tick * steps_per_period_ - stamp) * time_step_;
  info.stamp_ns = std::llround((time - info.age) * 1e9);
  info.sequence = static_cast<uint32_t>(arrival_);
  info.valid = 1;
  return info;
}

}  // namespace gaitd::sim
