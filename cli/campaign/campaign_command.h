// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "cli/context.h"

namespace gaitd::cli {

/// Adds `campaign`.
void add_campaign_command(CLI::App* app, Context* context);

}  // namespace gaitd::cli
