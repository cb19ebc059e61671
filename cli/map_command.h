// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "cli/context.h"

namespace gaitd::cli {

void add_map_command(CLI::App* app, Context* context);

}  // namespace gaitd::cli
