// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "cli/context.h"
#include "daemon/server/rpc.h"

namespace gaitd::cli {

/// Reports what went wrong and returns the exit code. People get "gaitctl: command: message" on
/// stderr; with --json stdout gets {"error": {command, exit_code, kind, message, code, data}}
/// besides, so that it holds one JSON document whatever happens. `command`: as one types it, "sim
/// push"; may be empty.
int fail(const Context& context, int exit_code, std::string_view command, std::string_view message);

/// The same for an error answer of the daemon. Exit code kFailed, or kNoDaemon where the daemon
/// went away before it answered.
int fail(const Context& context, std::string_view command, std::string_view method,
         const daemon::RpcError& error);

/// The message of a daemon about `method`, as it reads behind the name of the command: without the
/// name said twice, several lines indented below.
std::string message_for(std::string_view command, std::string_view method,
                        std::string_view message);

}  // namespace gaitd::cli
