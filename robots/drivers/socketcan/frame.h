// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace gaitd::can {

// In an identifier: it has 29 bits, not 11. As Linux has it.
inline constexpr uint32_t kExtended = 0x80000000;

struct Frame {
  uint32_t id = 0;     // with kExtended
  uint8_t length = 8;  // of one that came on CAN FD up to 64: the rest of its payload is left out
  std::array<uint8_t, 8> data{};
};

}  // namespace gaitd::can
