// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "cli/context.h"

namespace gaitd::cli {

/// Adds `sim push`, `sim load` and `sim reset`, which act on the simulation of the daemon.
void add_sim_commands(CLI::App* app, Context* context);

}  // namespace gaitd::cli
