// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "cli/context.h"

namespace gaitd::cli {

/// Adds `handhold take` and `handhold release`: hands that hold on to something.
void add_handhold_command(CLI::App* app, Context* context);

}  // namespace gaitd::cli
