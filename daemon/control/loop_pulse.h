// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <time.h>

#include <atomic>
#include <cstdint>

namespace gaitd::daemon {

/// What shows others that the control loop lives: it counts its rounds, also those that found no
/// new sensors. It depends on nothing that could hang beside the loop itself.
class LoopPulse {
 public:
  /// [control thread, between ticks]
  void beat() noexcept {
    time_ns_.store(now_ns(), std::memory_order_relaxed);
    rounds_.fetch_add(1, std::memory_order_release);
  }
  /// [any thread] 0 before the first.
  std::uint64_t rounds() const noexcept { return rounds_.load(std::memory_order_acquire); }
  /// [any thread] s since the last beat; 0 before the first.
  double age() const noexcept {
    if (rounds() == 0) return 0.0;
    return 1e-9 * static_cast<double>(now_ns() - time_ns_.load(std::memory_order_relaxed));
  }

 private:
  static std::int64_t now_ns() noexcept {
    timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return std::int64_t{1000000000} * t.tv_sec + t.tv_nsec;
  }
  std::atomic<std::uint64_t> rounds_{0};
  std::atomic<std::int64_t> time_ns_{0};
};

}  // namespace gaitd::daemon
