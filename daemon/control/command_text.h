// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

#include "daemon/command/command.h"

namespace gaitd::daemon {

// JSON of a command and its reply for the events of the log, written into `buffer`. [rt]
std::string_view command_text(const Command& command, const CommandReply& reply, char* buffer,
                              std::size_t size);

}  // namespace gaitd::daemon
