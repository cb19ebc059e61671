// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace gaitd::cli {

/// The params of `footsteps` from a YAML or JSON file ("-": standard input): a list of footsteps,
/// or a map with that list under `footsteps`, as in a scenario. On failure returns nothing and
/// `error` says file, line, key and what is wrong. Whether the robot can step there is for the
/// daemon to say.
std::optional<nlohmann::json> read_steps(const std::string& file, bool replace, std::string* error);

}  // namespace gaitd::cli
