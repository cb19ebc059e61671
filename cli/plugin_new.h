// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "cli/context.h"

namespace gaitd::cli {

/// Adds `plugin new`.
void add_plugin_new(CLI::App* plugin, Context* context);

}  // namespace gaitd::cli
