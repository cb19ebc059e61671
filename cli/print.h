// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace gaitd::cli {

/// The result of a method for people; ends with a newline. `command`: as one types it. Members that
/// this program does not know are shown as they are: an older gaitctl hides nothing.
std::string result_text(const std::string& command, const std::string& method,
                        const nlohmann::json& result);

/// One JSON value on indented lines, for --json; ends with a newline.
std::string json_text(const nlohmann::json& value);

}  // namespace gaitd::cli
