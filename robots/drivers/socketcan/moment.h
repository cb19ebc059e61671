// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gaitd::can {

// When something came: by the clock, and in which cycle, which is what counts in lockstep.
struct Moment {
  int64_t stamp_ns = 0;  // CLOCK_MONOTONIC
  int64_t cycle = 0;
};

}  // namespace gaitd::can
