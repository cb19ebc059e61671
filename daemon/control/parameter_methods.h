// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "daemon/parameters/live_parameters.h"
#include "daemon/server/command_bridge.h"
#include "daemon/server/rpc.h"

namespace gaitd::daemon {

/// Adds param.list, param.get and param.set. The first two read the present values without touching
/// the control thread; a set is taken by it at a tick. Both must outlive the server.
void add_parameter_methods(Methods* methods, CommandBridge* bridge,
                           const LiveParameters* parameters);

}  // namespace gaitd::daemon
