// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "cli/context.h"

namespace gaitd::cli {

/// Adds every command of gaitctl, and what `--help` says.
void add_commands(CLI::App* app, Context* context);

}  // namespace gaitd::cli
