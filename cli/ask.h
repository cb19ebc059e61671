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

/// An option that puts a number into `params` at `place`, a JSON pointer ("/pelvis/x"), if it is
/// given: gaitd knows the defaults of the robot.
CLI::Option* add_number(CLI::App* command, const std::string& option,
                        const std::shared_ptr<nlohmann::json>& params, const std::string& place,
                        const std::string& description);

/// Waits until the robot is not in `state` any more, at most for `longest`, or until this program
/// is to stop. Returns the faults, in words, of a robot that is in fault then; nothing otherwise.
std::string wait_while(RpcClient* client, const std::string& state,
                       std::chrono::milliseconds longest);

}  // namespace gaitd::cli
