// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gaitd::unitree {

// MotorState_.motorstate: the worst of its bits in words, "" if none is set. Bits that nobody
// published are errors too.
const char* motor_error_text(uint32_t bits);

// Above these a motor counts as broken; the figures are those the maker goes passive at.
inline constexpr int kHottestCase = 85, kHottestWinding = 120;  // °C

}  // namespace gaitd::unitree
