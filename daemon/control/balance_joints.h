// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "gaitd/abi/types.h"

namespace gaitd::daemon {

// Bit i is joint i.
using JointMask = std::uint64_t;
static_assert(GAITD_MAX_JOINTS <= 64);

// The joints without which the robot cannot keep its balance: both legs, and what lies between the
// pelvis and the chest or an IMU. The others, arms and head, may fail one by one while it walks.
JointMask balance_joints(const GaitdModel& model);

}  // namespace gaitd::daemon
