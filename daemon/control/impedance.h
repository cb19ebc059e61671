// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "daemon/config/robot.h"
#include "gaitd/walking/objectives.h"

namespace gaitd::daemon {

// Stiffness and damping of the drives in each state of a leg, if the robot has a profile of them.
void set_impedance(const ImpedanceProfile& profile, walking::ObjectiveBuilder* objectives);

}  // namespace gaitd::daemon
