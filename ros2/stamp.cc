// SPDX-License-Identifier: Apache-2.0
#include "ros2/stamp.h"

#include <cmath>
#include <limits>

namespace gaitd::ros2 {

Stamp to_stamp(std::int64_t nanoseconds) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  std::int64_t seconds = nanoseconds / kSecond;
  std::int64_t rest = nanoseconds % kSecond;
  if (rest < 0) {
    rest += kSecond;
    --seconds;
  }
  using Limits = std::numeric_limits<std::int32_t>;
  if (seconds > Limits::max()) return {Limits::max(), kSecond - 1};
  if (seconds < Limits::min()) return {Limits::min(), 0};
  return {static_cast<std::int32_t>(seconds), static_cast<std::uint32_t>(rest)};
}

Stamp to_stamp(double seconds) {
  constexpr double kMost = 9e9;  // s, that 64 bits of nanoseconds hold
  if (!std::isfinite(seconds)) return {0, 0};
  if (std::abs(seconds) > kMost) seconds = std::copysign(kMost, seconds);
  return to_stamp(static_cast<std::int64_t>(std::llround(seconds * 1e9)));
}

}  // namespace gaitd::ros2
