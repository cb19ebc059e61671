// SPDX-License-Identifier: Apache-2.0
#include "remote.h"

namespace gaitd::unitree {

uint16_t keys_of(const uint8_t (&remote)[kRemoteBytes]) {
  return static_cast<uint16_t>(remote[2] | remote[3] << 8);
}

const char* estop_keys(uint16_t keys) {
  constexpr uint16_t kNow = kL2 | kB;
  constexpr uint16_t kBefore = kL1 | kA;
  if ((keys & kNow) == kNow) return "L2+B";
  if ((keys & kBefore) == kBefore) return "L1+A";
  if ((keys & kSelect) != 0) return "select";
  return nullptr;
}

}  // namespace gaitd::unitree
