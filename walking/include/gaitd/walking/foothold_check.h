// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gaitd/abi/types.h"
#include "gaitd/walking/refusal.h"

namespace gaitd::walking {

// Whether a robot can stand on the contact polygon of a footstep, if it has one: a convex outline,
// counter-clockwise, on the sole and not too small. `number` names the footstep in the message,
// from 1.
Refusal check_contact_polygon(const GaitdModel& model, const GaitdFootstep& step, int number);

}  // namespace gaitd::walking
