// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "cli/context.h"

namespace gaitd::cli {

/// `goto`: footsteps to a place.
void add_goto_command(CLI::App* app, Context* context);

}  // namespace gaitd::cli
