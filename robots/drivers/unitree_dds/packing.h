// SPDX-License-Identifier: Apache-2.0
// The robot's messages and what gaitd makes of them.
#pragma once

#include <cstdint>

#include "dds_node.h"
#include "exchange.h"

namespace gaitd::unitree {

// In lockstep the fake robot counts its states in `reserve`, and a command says in the same place
// which of them it answers. A real robot leaves it 0, and then it is never written.
inline constexpr uint32_t kLockstepMark = 0x67414954;
uint64_t cycle_of(const LowState& state);
uint64_t cycle_of(const LowCmd& command);
void set_cycle(uint64_t cycle, LowState* state);

// The message of a command. `measured`: rad, by index; what is damped is told to stay there.
// `motors`: bit i, the robot has a motor of index i; the others are off. With its CRC.
LowCmd pack(const Command& command, uint64_t motors, const float (&measured)[kMotors],
            uint8_t mode_machine);

// Motors and pelvis IMU of a message; stamps and counters stay as they are.
void unpack(const LowState& message, State* state);
void unpack(const ImuState& message, ImuReading* reading);

// No figure of the motors in the mask or of the IMU is NaN or infinite.
bool all_finite(const LowState& message, uint64_t motors);
bool all_finite(const ImuState& message);

}  // namespace gaitd::unitree
