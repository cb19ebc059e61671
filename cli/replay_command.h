// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "cli/context.h"

namespace gaitd::cli {

/// Adds `log replay` to the command `log`.
void add_replay_command(CLI::App* log, Context* context);

}  // namespace gaitd::cli
