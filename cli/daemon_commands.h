// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "cli/context.h"

namespace gaitd::cli {

/// Adds the commands that send one request to a running daemon and print its answer.
void add_daemon_commands(CLI::App* app, Context* context);

}  // namespace gaitd::cli
