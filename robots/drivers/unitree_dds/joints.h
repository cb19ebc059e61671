// SPDX-License-Identifier: Apache-2.0
// Which motor index on the wire moves which joint, and which of them a variant of the robot has.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace gaitd::unitree {

inline constexpr int kSlots = 35;   // motors in a message
inline constexpr int kMotors = 29;  // those of the humanoid, the first ones

// Joint names of the maker's URDF in the order of the wire, mode_pr 0: indices 4, 5, 10, 11, 13 and
// 14 are pitch and roll of ankle and waist, which the robot converts to its parallel drives.
extern const std::array<const char*, kMotors> kJointNames;

// -1 if there is no such joint.
int wire_index(const std::string& name);

// A variant of the robot as LowState_.mode_machine numbers it.
struct Variant {
  uint8_t number;
  const char* name;
  uint64_t missing;     // bit i: there is no motor of index i, or its joint is locked
  const char* warning;  // where it differs from the published 29-joint body; "" if not
};

// Null if nobody published what the number means.
const Variant* find_variant(int mode_machine);

}  // namespace gaitd::unitree
