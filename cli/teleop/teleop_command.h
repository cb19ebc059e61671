// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "cli/context.h"

namespace gaitd::cli {

/// `teleop`: drives the robot by keyboard or gamepad.
void add_teleop_command(CLI::App* app, Context* context);

}  // namespace gaitd::cli
