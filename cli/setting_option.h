// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "cli/context.h"

namespace gaitd::cli {

/// --set KEY=VALUE, as often as one likes, with completion of the keys. `settings` has to live as
/// long as the command.
CLI::Option* add_settings(CLI::App* command, Context* context, std::vector<std::string>* settings,
                          const std::string& description);

}  // namespace gaitd::cli
