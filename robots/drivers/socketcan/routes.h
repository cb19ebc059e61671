// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gaitd::can {

// What an identifier belongs to: kind and index in one number.
enum Route : int16_t {
  kNobody = 0,
  kMotor = 0x1000,
  kImu = 0x2000,
  kFoot = 0x3000,
  kEstop = 0x4000,
  kCycleOver = 0x5000
};
inline constexpr int16_t kKind = 0x7000, kIndex = 0x0FFF;

}  // namespace gaitd::can
