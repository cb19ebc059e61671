// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace gaitd::cli {

/// The status of the daemon as a table for a screen. What is missing in it is shown as "-".
std::vector<std::string> status_screen(const nlohmann::json& status);

/// The state of the robot. What a control loop that hangs said last is not how the robot is now.
std::string state_text(const nlohmann::json& status);

/// The hands that hold on, of `handholds` of a status, on one line.
std::string handholds_text(const nlohmann::json& handholds);

/// What the robot carries, of `payload` of a status, on one line.
std::string payload_text(const nlohmann::json& payload);

/// The status on one line, for outputs that are no terminal.
std::string status_line(const nlohmann::json& status);

}  // namespace gaitd::cli
