// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/context.h"
#include "cli/rpc_client.h"

namespace gaitd::cli {

/// A connection to the daemon of --socket or of the usual places. Null if there is none: that has
/// been reported then, and the exit code is kNoDaemon. `role`: the least that will be asked for.
std::unique_ptr<RpcClient> connect(const Context& context, const std::string& command,
                                   daemon::Role role);

/// Sends one request and prints its answer, or why not; returns the exit code. `command`: as one
/// types it, "sim push". After `arm` and `sim.reset` it waits until the robot takes commands.
int ask(const Context& context, const std::string& command, const std::string& method,
        const nlohmann::json& params, std::chrono::milliseconds timeout = std::chrono::seconds(10));

/// Adds a command without arguments of its own that calls `method`. Its name in messages is that of
/// its parents and its own.
CLI::App* add_plain(CLI::App* app, Context* context, const std::string& name,
                    const std::string& method, const std::string& description);

}  // namespace gaitd::cli
