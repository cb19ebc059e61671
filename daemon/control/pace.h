// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "daemon/config/daemon_config.h"

namespace gaitd::daemon {

// When the ticks of a realtime loop are due, and whether they keep up. Fed with times of the
// monotonic clock (ns), so that it can be tested without one. [rt]
class Pace {
 public:
  // `period` and `longest_run`, realtime.overrun_run, in s.
  Pace(double period, OverrunPolicy policy, double longest_run);

  void start(std::int64_t now) { due_ = now; }

  struct Next {
    std::int64_t due;      // ns, when the next tick has to begin
    bool overrun = false;  // it should have begun already
    bool fault = false;    // the loop has been behind for too long, whether in one tick or in many
  };
  // After a tick, at the time `now`.
  Next after_tick(std::int64_t now);

  // How long the loop has been behind, s: since the first tick that could not begin when it was
  // due, if none was in time since. 0: it keeps up.
  double behind() const { return 1e-9 * static_cast<double>(behind_); }

 private:
  const std::int64_t period_;       // ns
  const std::int64_t longest_run_;  // ns
  const OverrunPolicy policy_;
  std::int64_t due_ = 0;
  std::int64_t first_missed_ = 0;
  std::int64_t behind_ = 0;
};

}  // namespace gaitd::daemon
