// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "cli/context.h"

namespace gaitd::cli {

/// `drive`: walks at a velocity, which it renews until it ends.
void add_drive_command(CLI::App* app, Context* context);

}  // namespace gaitd::cli
