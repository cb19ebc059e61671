// SPDX-License-Identifier: Apache-2.0
#include "cli/ask.h"

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <thread>

#include "cli/failure.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "cli/stop_signals.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;

constexpr std::chrono::seconds kReadying{15};

// What both versions are, if they differ; "" otherwise.
std::string other_version(RpcClient* client) {
  const daemon::RpcResult result = client->call("version", nullptr);
  const json* value = std::get_if<json>(&result);
  if (value == nullptr || !value->is_object()) return "";
  const json version = value->value("version", json());
  if (!version.is_string() || version == GAITD_VERSION) return "";
  return "this gaitd is version " + version.get<std::string>() +
         ", gaitctl is " GAITD_VERSION "; start the gaitd that was installed with this gaitctl";
}

// Names of a command and the commands it is in, without the program.
std::string full_name(const CLI::App* command) {
  const CLI::App* parent = command->get_parent();
  if (parent == nullptr) return "";
  const std::string before = full_name(parent);
  return before.empty() ? command->get_name() : before + " " + command->get_name();
}

constexpr int kEstopTries = 100;

bool turned_away(const daemon::RpcResult& result) {
  const auto* error = std::get_if<daemon::RpcError>(&result);
  return error != nullptr &&
         (error->code == daemon::rpc_code::kBusy || error->code == kConnectionLost);
}

daemon::Role needed_role(const std::string& method, const json& params) {
  const json name = params.is_object() ? params.value("name", json()) : json();
  const bool guarded = name.is_string() && daemon::is_guarded(name.get<std::string>());
  return method == "param.set" && guarded ? daemon::Role::kAdminister : daemon::least_role(method);
}

}  // namespace

std::unique_ptr<RpcClient> connect(const Context& context, const std::string& command,
                                   daemon::Role role) {
  std::string error;
  auto client = RpcClient::connect(Destination::of(context.socket, role), &error);
  if (!client) fail(context, kNoDaemon, command, error);
  return client;
}

int ask(const Context& context, const std::string& command, const std::string& method,
        const json& params, std::chrono::milliseconds timeout) {
  auto client = connect(context, command, needed_role(method, params));
  if (!client) return kNoDaemon;
  std::optional<Waiting> waiting(command);
  daemon::RpcResult result = client->call(method, params, timeout);
  // Whoever wants to stop the robot does not go away because many knock at the door.
  for (int again = 0; method == "estop" && again < kEstopTries && turned_away(result); ++again) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    client = connect(context, command, daemon::Role::kObserve);
    if (!client) return kNoDaemon;
    result = client->call(method, params, timeout);
  }
  if (auto* error = std::get_if<daemon::RpcError>(&result)) {
    waiting.reset();
    // Two programs of different versions may not know the same methods and params.
    if (error->code == daemon::rpc_code::kMethodNotFound ||
        error->code == daemon::rpc_code::kInvalidParams) {
      const std::string versions = other_version(client.get());
      if (!versions.empty()) error->message += "\n" + versions;
    }
    return fail(context, command, method, *error);
  }
  if (method == "arm" || method == "sim.reset") {
    // Until it takes commands.
    if (const std::string faults = wait_while(client.get(), "readying", kReadying);
        !faults.empty()) {
      waiting.reset();
      return fail(context, kFailed, command, faults);
    }
  }
  waiting.reset();
  json& value = std::get<json>(result);
  // Whoever did not name the socket learns which one it was.
  if (context.socket.empty() && value.is_object() && value.contains("accepted")) {
    value["socket"] = client->path();
  }
  std::cout << (context.json ? json_text(value) : result_text(command, method, value))
            << std::flush;
  return kDone;
}

CLI::App* add_plain(CLI::App* app, Context* context, const std::string& name,
                    const std::string& method, const std::string& description) {
  CLI::App* command = app->add_subcommand(name, description);
  command->callback([context, method, full = full_name(command)] {
    context->action = [context, method, full] { return ask(*context, full, method, nullptr); };
  });
  return command;
}

CLI::Option* add_number(CLI::App* command, const std::string& option,
                        const std::shared_ptr<json>& params, const std::string& place,
                        const std::string& description) {
  return command
      ->add_option_function<double>(
          option,
          [params, place = json::json_pointer(place)](double value) { (*params)[place] = value; },
          description)
      ->check([](const std::string& text) {
        const bool finite = std::isfinite(std::strtod(text.c_str(), nullptr));
        return finite ? std::string() : text + ": a finite number expected";
      });
}

std::string wait_while(RpcClient* client, const std::string& state,
                       std::chrono::milliseconds longest) {
  using Clock = std::chrono::steady_clock;
  for (const auto end = Clock::now() + longest; Clock::now() < end && !StopSignals::requested();) {
    const daemon::RpcResult result = client->call("status", nullptr, std::chrono::seconds(2));
    const json* status = std::get_if<json>(&result);
    if (status == nullptr || !status->is_object()) return "";
    const json now = status->value("state", json());
    if (now == "fault") {
      return "the robot is in fault: " + status->value("faults", json::array()).dump() +
             "; `gaitctl status` says more";
    }
    if (now != state) return "";
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return "";
}

}  // namespace gaitd::cli
