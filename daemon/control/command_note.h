// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "daemon/command/command.h"
#include "daemon/control/tick_data.h"

namespace gaitd::daemon {

// What an operator should know about a command that is accepted in this state, before it is carried
// out: that there is nothing to do, or that its effect waits. Null: it does what its name says.
// [rt]
const char* command_note(const Command& command, SafetyState state, const GaitdGaitState& gait);

}  // namespace gaitd::daemon
