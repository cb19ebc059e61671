// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "cli/context.h"

namespace gaitd::cli {

/// Adds `compare`: one scenario under two configurations, figures side by side.
void add_compare_command(CLI::App* app, Context* context);

}  // namespace gaitd::cli
