// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "cli/context.h"

namespace gaitd::cli {

/// Adds `watch`, which shows the status of the daemon again and again: a table that stays in place
/// on a terminal that can do so, a line each time otherwise.
void add_watch_command(CLI::App* app, Context* context);

}  // namespace gaitd::cli
