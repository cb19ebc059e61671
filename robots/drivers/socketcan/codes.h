// SPDX-License-Identifier: Apache-2.0
// Figures as unsigned codes of some bits, as all drives in MIT mode pack them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace gaitd::can {

// Code of a value, clamped into min..max: floor((x - min) (2^bits - 1) / (max - min)). What is no
// number becomes the middle.
inline uint32_t to_code(double value, double minimum, double maximum, int bits) {
  const double top = (1u << bits) - 1;
  const double inside =
      std::isnan(value) ? 0.5 * (minimum + maximum) : std::clamp(value, minimum, maximum);
  // Without the small share a value that came from a code may fall to the code below.
  constexpr double kShare = 1e-6;
  return static_cast<uint32_t>((inside - minimum) * top / (maximum - minimum) + kShare);
}

inline double from_code(uint32_t code, double minimum, double maximum, int bits) {
  const double top = (1u << bits) - 1;
  return minimum + code * (maximum - minimum) / top;
}

}  // namespace gaitd::can
