// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/context.h"

namespace gaitd::cli {

/// Plays the commands of a scenario on the running gaitd, in the distances of their times, and
/// waits wherever the robot needs longer. `log` becomes the log that gaitd writes meanwhile. An
/// exit code; 0: all was done.
int play_live(const Context& context, const std::string& scenario, std::string* log);

}  // namespace gaitd::cli
