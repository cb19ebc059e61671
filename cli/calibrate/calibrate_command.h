// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/context.h"

namespace CLI {
class App;
}

namespace gaitd::cli {

/// `gaitctl calibrate`: zeros, stiffnesses and foot sensors of one robot, by its own motions.
void add_calibrate_command(CLI::App* app, Context* context);

}  // namespace gaitd::cli
