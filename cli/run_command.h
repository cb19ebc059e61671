// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "cli/context.h"

namespace gaitd::cli {

/// Adds `run`, which plays scenarios on a private daemon.
void add_run_command(CLI::App* app, Context* context);

}  // namespace gaitd::cli
