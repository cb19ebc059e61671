// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "daemon/command/command.h"

namespace gaitd::daemon {

// A command with all that it says, for the log: what replay takes it from again, to the bit.
// {"command": name, ...}; a parameter by its place in the table of its owner.
std::string input_text(const Command& command, int parameter_owner, int parameter_place);

// The same back. False if the text is none. The parameter's owner and place go to the other two.
bool read_input(const nlohmann::json& input, Command* command, int* parameter_owner,
                int* parameter_place);

}  // namespace gaitd::daemon
