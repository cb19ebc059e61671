// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "cli/context.h"

namespace gaitd::cli {

void add_tune_command(CLI::App* campaign, Context* context);

}  // namespace gaitd::cli
