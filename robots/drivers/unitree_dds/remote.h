// SPDX-License-Identifier: Apache-2.0
// The robot's own remote, as LowState_.wireless_remote carries it.
#pragma once

#include <cstdint>

namespace gaitd::unitree {

inline constexpr int kRemoteBytes = 40;

// Bits of the keys: byte 2, then byte 3.
enum Key : uint16_t {
  kR1 = 1 << 0,
  kL1 = 1 << 1,
  kStart = 1 << 2,
  kSelect = 1 << 3,
  kR2 = 1 << 4,
  kL2 = 1 << 5,
  kF1 = 1 << 6,
  kF2 = 1 << 7,
  kA = 1 << 8,
  kB = 1 << 9,
  kX = 1 << 10,
  kY = 1 << 11,
  kUp = 1 << 12,
  kRight = 1 << 13,
  kDown = 1 << 14,
  kLeft = 1 << 15,
};

uint16_t keys_of(const uint8_t (&remote)[kRemoteBytes]);

// The combinations that ask for damping: L2+B, L1+A (firmware before 8.2) and select, whatever else
// is pressed with them. Null if none is; else its name.
const char* estop_keys(uint16_t keys);

}  // namespace gaitd::unitree
