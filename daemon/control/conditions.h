// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "daemon/control/balance_joints.h"
#include "daemon/control/tick_data.h"
#include "daemon/parameters/safety_parameters.h"

namespace gaitd::daemon {

// What is asked of the safety machine and may be refused. Bits of Condition::refuses.
enum Request : unsigned {
  kRequestStart = 1u << 0,  // a simulated robot comes up armed, before its first readings
  kRequestArm = 1u << 1,
  kRequestJointTest = 1u << 2,
  kRequestWalk = 1u << 3,  // any command that needs the robot under control
  kRequestDisarm = 1u << 4,
};

// Bits of Condition::ticks.
constexpr unsigned state_bit(SafetyState state) { return 1u << static_cast<unsigned>(state); }

// What conditions are judged by.
struct Circumstances {
  const GaitdModel& model;
  const sdk::Parameters<SafetyParameter>& parameters;
  const JointMask balance;  // balance_joints() of the model
  const TickData& tick;
  SafetyState state;
  bool estimated = false;     // the robot state is sound
  bool out_of_reach = false;  // CaptureCheck::lost()
};

// Something that must not be. The one place that says what it means: the requests that it refuses
// and why, and the fault it is while the robot is on. docs/safety.md shows the same table.
struct Condition {
  const char* name;
  bool (*holds)(const Circumstances&);
  unsigned refuses;      // requests
  const char* refusal;   // said to them; null if it refuses none
  unsigned ticks;        // states in whose ticks it is looked at
  std::uint32_t faults;  // that it raises there; 0: none
};

// In the order in which they are told.
std::span<const Condition> conditions();

// The refusal of the first condition that stands against the request, or null.
const char* refusal_of(Request request, const Circumstances& now);

}  // namespace gaitd::daemon
