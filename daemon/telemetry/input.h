// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "daemon/command/command.h"

namespace gaitd::daemon {

// A command with all that it says, at the tick that took it.
struct Input {
  std::int64_t tick = 0;
  double time = 0.0;  // s
  Command command;
  int parameter_owner = -1;  // of kSetParameter
  int parameter_place = -1;  // in the table of its owner
};

}  // namespace gaitd::daemon
