// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace gaitd::cli {

/// The params of `footsteps` from a YAML or JSON file ("-": standard input): a list of footsteps,
/// or a map with that list under `footsteps`, as in a scenario. What is in a footstep is for the
/// daemon to check. On failure returns nothing and `error` says file, line and what is wrong.
std::optional<nlohmann::json> read_steps(const std::string& file, bool replace, std::string* error);

}  // namespace gaitd::cli
