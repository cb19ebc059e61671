// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/context.h"

namespace gaitd::cli {

/// Plays the commands of a scenario on the running gaitd (empty: the motions made for its robot),
/// in the distances of their times, and waits wherever the robot or its hoist needs longer. `logs`
/// become those that gaitd writes meanwhile: a full one goes on in another. An exit code; 0: all
/// was done.
int play_live(const Context& context, const std::string& scenario, std::vector<std::string>* logs);

}  // namespace gaitd::cli
