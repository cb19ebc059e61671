// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace gaitd::cli {

/// Rows under a header, columns as wide as they need, no trailing blanks. Rows may be short.
std::string table(const std::vector<std::string>& header,
                  const std::vector<std::vector<std::string>>& rows);

/// The result of a method for people; ends with a newline. `command`: as one types it. Members that
/// this program does not know are shown as they are: an older gaitctl hides nothing.
std::string result_text(const std::string& command, const std::string& method,
                        const nlohmann::json& result);

/// One JSON value on indented lines, for --json; ends with a newline.
std::string json_text(const nlohmann::json& value);

}  // namespace gaitd::cli
