// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/transport.h"

#include <algorithm>
#include <cmath>

namespace gaitd::sim {
namespace {

constexpr double kLongestTail = 0.005;  // s

// Whole numbers of a range, all with the same chance.
int sample_count(const Draw& range, double x) {
  const double low = std::floor(range.low()), high = std::floor(range.high());
  return static_cast<int>(std::min(high, low + std::floor((high - low + 1) * x)));
}

double mean_count(const Draw& range) {
  return 0.5 * (std::floor(range.low()) + std::floor(range.high()));
}

}  // namespace

Transport::Transport(const SensorFigures& figures, const Draw& delay, double time_step,
                     int steps_per_period, uint64_t seed, uint64_t index)
    : figures_(figures),
      delay_range_(delay),
      time_step_(time_step),
      steps_per_period_(steps_per_period),
      seed_(seed),
      index_(index),
      longest_(delay_steps(delay.high() + figures.jitter.high() +
                           (figures.jitter_tail.zero() ? 0.0 : kLongestTail))),
      stream_(seed, RandomPurpose::kTiming, index) {
  reset();
}

int Transport::delay_steps(double delay) const {
  return static_cast<int>(std::llround(std::max(0.0, delay) / time_step_));
}

void Transport::reset() {
  stream_ = RandomStream(seed_, RandomPurpose::kTiming, index_);
  delay_ = delay_range_.sample(&stream_);
  jitter_ = figures_.jitter.sample(&stream_);
  tail_ = figures_.jitter_tail.sample(&stream_);
  loss_chance_ = figures_.lost_frames.sample(&stream_) / mean_count(figures_.lost_burst);
  lost_ = 0;
  step_ = -delay_steps(delay_);
  arrival_ = 0;
}

bool Transport::advance(int64_t tick) {
  // All four every time: one figure changes nothing of the others.
  const double early_or_late = 2 * stream_.uniform() - 1;
  const double tail = -std::log(stream_.uniform());
  const bool loss = stream_.uniform() <= loss_chance_;
  const int burst = sample_count(figures_.lost_burst, stream_.uniform());
  if (lost_ == 0 && loss) lost_ = burst;
  if (lost_ > 0) {
    --lost_;
    return false;
  }
  const double delay = delay_ + jitter_ * early_or_late + std::min(tail_ * tail, kLongestTail);
  const int64_t step = tick * steps_per_period_ - delay_steps(delay);
  if (step <= step_) return false;
  step_ = step;
  arrival_ = tick;
  return true;
}

GaitdSignalInfo Transport::info(int64_t tick, double time) const {
  const int64_t stamp = figures_.arrival_stamps ? arrival_ * steps_per_period_ : step_;
  GaitdSignalInfo info{};
  info.age = static_cast<double>(tick * steps_per_period_ - stamp) * time_step_;
  info.stamp_ns = std::llround((time - info.age) * 1e9);
  info.sequence = static_cast<uint32_t>(arrival_);
  info.valid = 1;
  return info;
}

}  // namespace gaitd::sim
