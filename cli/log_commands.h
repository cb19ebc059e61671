// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "cli/context.h"

namespace gaitd::cli {

/// Adds `log info` and `log export`, which read a log file; no daemon is needed.
void add_log_commands(CLI::App* app, Context* context);

}  // namespace gaitd::cli
