// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "cli/context.h"

namespace gaitd::cli {

/// Adds `payload estimate`, `payload set` and `payload clear`: what the robot carries.
void add_payload_command(CLI::App* app, Context* context);

}  // namespace gaitd::cli
