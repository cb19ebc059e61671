// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gaitd::daemon {

/// Judges whether the control loop still goes round: a plugin that never returns can be neither
/// interrupted nor unloaded, so all that is left is to say so and to end. It counts its own looks
/// and not seconds: a process that was stopped, or a machine that slept, does not hang.
class HangGuard {
 public:
  static constexpr double kTell = 1.0;  // s without a round after which it is told
  static constexpr double kAsked =
      2.0;  // s, likewise: after which a stop that was asked for waits no more
  static constexpr double kLockstep = 60.0;  // s after which a run in lockstep has failed

  enum class Verdict {
    kRuns,
    kHangs,   // told once
    kGiveUp,  // the process has to end without its control loop
  };

  /// `period`: s between two looks. In lockstep nothing outside, as a service manager or the
  /// drives of a robot, notices that no tick comes; with `lockstep` the guard does.
  HangGuard(double period, bool lockstep) : period_(period), lockstep_(lockstep) {}

  /// `rounds` of the loop so far (0: it has not begun), whether it is `inside` a plugin, and
  /// whether a stop was asked for. A loop that waits for a disk is not inside.
  Verdict look(std::uint64_t rounds, bool inside, bool stop_requested) {
    if (rounds != rounds_ || rounds == 0 || !inside) {
      rounds_ = rounds;
      looks_ = 0;
      told_ = false;
      return Verdict::kRuns;
    }
    ++looks_;
    const double still = period_ * looks_;
    if ((stop_requested && still >= kAsked) || (lockstep_ && still >= kLockstep)) {
      return Verdict::kGiveUp;
    }
    if (still < kTell || told_) return Verdict::kRuns;
    told_ = true;
    return Verdict::kHangs;
  }

 private:
  const double period_;
  const bool lockstep_;
  std::uint64_t rounds_ = 0;
  int looks_ = 0;
  bool told_ = false;
};

}  // namespace gaitd::daemon
