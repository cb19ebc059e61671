// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "cli/context.h"

namespace gaitd::cli {

/// Adds `param list|get|set`, which ask a running daemon, and `param reference`, which does not.
void add_param_commands(CLI::App* app, Context* context);

}  // namespace gaitd::cli
