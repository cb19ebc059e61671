// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

namespace gaitd::daemon {

/// The way of an e-stop from whoever reads it to the control thread. It depends on nothing: no
/// queue that could be full, no lock, no parameters. Stops that come between two ticks are one.
class EstopFlag {
 public:
  // ---- Any thread.

  /// Sets the flag. The number to ask acted_on() for.
  std::uint64_t raise() noexcept { return asked_.fetch_add(1, std::memory_order_acq_rel) + 1; }
  /// How many stops have been asked for.
  std::uint64_t asked() const noexcept { return asked_.load(std::memory_order_acquire); }
  /// Whether the control thread has taken the stop of that number, or a later one.
  bool acted_on(std::uint64_t number) const noexcept {
    return acted_.load(std::memory_order_acquire) >= number;
  }
  /// The tick that took the newest stop that was taken; that of the tick under way or next, if
  /// none.
  std::int64_t tick() const noexcept { return tick_.load(std::memory_order_acquire); }
  /// The tick under way or next.
  std::int64_t present_tick() const noexcept { return present_.load(std::memory_order_acquire); }

  // ---- Control thread, before each tick. [rt]

  /// True if somebody has asked for a stop since the last call.
  bool take(std::int64_t tick) noexcept {
    present_.store(tick, std::memory_order_release);
    const std::uint64_t asked = asked_.load(std::memory_order_acquire);
    if (asked == acted_.load(std::memory_order_relaxed)) return false;
    tick_.store(tick, std::memory_order_release);
    acted_.store(asked, std::memory_order_release);
    return true;
  }

 private:
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
  std::atomic<std::uint64_t> asked_{0};
  std::atomic<std::uint64_t> acted_{0};
  std::atomic<std::int64_t> tick_{0};
  std::atomic<std::int64_t> present_{0};
};

}  // namespace gaitd::daemon
