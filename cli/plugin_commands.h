// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "cli/context.h"

namespace gaitd::cli {

/// Adds `plugin check` to the command `plugin`, which is there already; no daemon is needed.
void add_plugin_commands(CLI::App* app, Context* context);

}  // namespace gaitd::cli
