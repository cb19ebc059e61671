// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/verdict/run_data.h"

namespace gaitd::daemon {

// Step k is the k-th swing and owns the transfer before it.
struct Step {
  std::size_t begin = 0;   // first tick of the swing
  std::size_t end = 0;     // one past its last
  bool completed = false;  // the foot came down before the log ended and before any fall
  bool closing = false;    // only puts the foot beside the other one: does not count
  bool toe_off = false;    // lifted off out of toe-off: it was active at the last tick before
};

struct Fall {
  std::size_t tick = 0;
  std::string reason;
};

// The first tick at which the robot has fallen: the fall bit of the faults, the pelvis lower over
// the lower foot than 60 % of what it was at the start, or tilted by more than 1 rad.
std::optional<Fall> find_fall(const RunData& run);

std::vector<Step> find_steps(const RunData& run, const std::optional<Fall>& fall);

}  // namespace gaitd::daemon
