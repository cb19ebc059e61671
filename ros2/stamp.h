// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

#include "builtin_interfaces.h"

namespace gaitd::ros2 {

using Stamp = builtin_interfaces_msg_dds__Time_;

/// Nanoseconds since the epoch of a clock. The fraction counts upwards, also before the epoch; what
/// 32 bits of seconds do not hold is the end that is nearer.
Stamp to_stamp(std::int64_t nanoseconds);

/// A moment of the tick clock, s; the epoch where it is no number.
Stamp to_stamp(double seconds);

inline Stamp now() {
  return to_stamp(std::chrono::duration_cast<std::chrono::nanoseconds>(
                      std::chrono::system_clock::now().time_since_epoch())
                      .count());
}

}  // namespace gaitd::ros2
