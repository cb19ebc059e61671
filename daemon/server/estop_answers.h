// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>

#include "daemon/command/estop_flag.h"
#include "daemon/server/rpc.h"

namespace gaitd::daemon {

/// Raises the e-stop at once, and answers when the control thread has acted on it: `tick` is the
/// one that did, `read_at_tick` the one under way when the request was read. On one thread.
class EstopAnswers {
 public:
  using Clock = std::chrono::steady_clock;
  /// An answer is held back until the stop shows in the status, at most so long.
  static constexpr Clock::duration kShowTime = std::chrono::milliseconds(200);
  /// When the control thread counts as hung.
  static constexpr Clock::duration kPatience = std::chrono::seconds(1);

  /// `flag` must outlive it.
  explicit EstopAnswers(EstopFlag* flag) : flag_(flag) {}

  /// `raised`: the number of the stop, if it has been raised already.
  void stop(Respond respond, std::uint64_t raised = 0);
  /// Gives the answers that are due.
  void poll(Clock::time_point now);
  bool waiting() const { return !waiting_.empty(); }
  /// gaitd stops, and with it the robot: answers everything that waits.
  void abandon();

 private:
  struct Waiting {
    std::uint64_t number;
    std::int64_t read_at;
    double raised_at;  // s, CLOCK_MONOTONIC
    Clock::time_point since;
    Respond respond;
  };
  bool answer(const Waiting& one, Clock::time_point now) const;  // false: not yet

  EstopFlag* flag_;
  std::deque<Waiting> waiting_;
};

}  // namespace gaitd::daemon
