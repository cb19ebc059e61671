// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>

namespace gaitd::cli {

/// Picks out of what comes so many a second as somebody wants, evenly in the mean, whatever the
/// rate at which it comes.
class Pace {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr double kHighest = 60.0;  // Hz

  explicit Pace(double hz = kHighest)
      : period_(std::chrono::duration_cast<Clock::duration>(
            std::chrono::duration<double>(1.0 / std::clamp(hz, 1.0, kHighest)))) {}

  /// Whether what comes now is one of them.
  bool due(Clock::time_point now) {
    // What comes a little early is not left out, or a jitter would halve the rate.
    constexpr auto kEarly = std::chrono::duration<double>(0.5 / kHighest);
    if (now < next_ - std::chrono::duration_cast<Clock::duration>(kEarly)) return false;
    next_ = std::max(next_ + period_, now);
    return true;
  }

 private:
  Clock::duration period_;
  Clock::time_point next_{};
};

}  // namespace gaitd::cli
