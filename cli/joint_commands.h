// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "cli/context.h"

namespace gaitd::cli {

/// Adds `joint list` and `joint test`, for the bring-up of a robot.
void add_joint_commands(CLI::App* app, Context* context);

}  // namespace gaitd::cli
