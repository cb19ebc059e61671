// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/frame_timing.h"

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

double FrameTiming::latest() const {
  return figures_.jitter.high() + (figures_.jitter_tail.zero() ? 0.0 : kLongestTail);
}

void FrameTiming::draw(RandomStream* stream) {
  jitter_ = figures_.jitter.sample(stream);
  tail_ = figures_.jitter_tail.sample(stream);
  loss_chance_ = figures_.lost_frames.sample(stream) / mean_count(figures_.lost_burst);
  lost_ = 0;
}

std::optional<double> FrameTiming::next(RandomStream* stream) {
  // All four every time: one figure changes nothing of the others.
  const double early_or_late = 2 * stream->uniform() - 1;
  const double tail = -std::log(stream->uniform());
  const bool loss = stream->uniform() <= loss_chance_;
  const int burst = sample_count(figures_.lost_burst, stream->uniform());
  if (lost_ == 0 && loss) lost_ = burst;
  if (lost_ > 0) {
    --lost_;
    return std::nullopt;
  }
  return jitter_ * early_or_late + std::min(tail_ * tail, kLongestTail);
}

}  // namespace gaitd::sim
