// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/context.h"

namespace CLI {
class App;
}

namespace gaitd::cli {

/// `gaitctl doctor`: of this machine, of a robot, of a log.
void add_doctor_command(CLI::App* app, Context* context);

}  // namespace gaitd::cli
