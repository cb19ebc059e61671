// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "cli/context.h"

namespace gaitd::cli {

/// `view`: serves the live page.
void add_view_command(CLI::App* app, Context* context);

}  // namespace gaitd::cli
