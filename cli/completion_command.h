// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "cli/context.h"

namespace gaitd::cli {

/// Adds `completion`, which prints the script that completes gaitctl and gaitd in a shell.
void add_completion_command(CLI::App* app, Context* context);

}  // namespace gaitd::cli
