// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

#include "daemon/command/command.h"

namespace gaitd::daemon {

// JSON of a command and its reply for the events of the log, written into `buffer`. [rt]
std::string_view command_text(const Command& command, const CommandReply& reply, char* buffer,
                              std::size_t size);

// The same of a kSetParameter with the key of its parameter: {"name", "old", "new", "request"}, and
// as a command with its reason where it was refused. [rt]
std::string_view parameter_text(const char* key, const Command& command, const CommandReply& reply,
                                char* buffer, std::size_t size);

// {what: link, "body", "mass", "com"} of a load: "load" of the simulation, "payload" of one that
// was weighed. [rt]
std::string_view load_text(const char* what, const GaitdLoad& load, const char* link, char* buffer,
                           std::size_t size);
// {what: text}. [rt]
std::string_view note_text(const char* what, const char* text, char* buffer, std::size_t size);
// {"push": link, "force", "point", "duration"} of a push that was made. [rt]
std::string_view push_text(const GaitdDisturbance& push, const char* link, char* buffer,
                           std::size_t size);

}  // namespace gaitd::daemon
