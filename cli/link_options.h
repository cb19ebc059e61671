// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/context.h"

namespace gaitd::cli {

/// --link NAME, a link of the robot; completion offers those of all installed robots.
CLI::Option* add_link(CLI::App* command, Context* context,
                      const std::shared_ptr<nlohmann::json>& params,
                      const std::string& description);

/// An option X,Y,Z that puts three numbers into `params` under `key`.
CLI::Option* add_vector(CLI::App* command, const std::string& option,
                        const std::shared_ptr<nlohmann::json>& params, const std::string& key,
                        const std::string& description);

/// A mass that `command` puts on a link: --link, --mass, --com.
void add_load(CLI::App* command, Context* context, const std::shared_ptr<nlohmann::json>& params);

}  // namespace gaitd::cli
