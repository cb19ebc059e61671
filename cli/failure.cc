// SPDX-License-Identifier: Apache-2.0
#include "cli/failure.h"

#include <array>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/print.h"
#include "cli/rpc_client.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;

struct Failure {
  int exit_code = kFailed;
  std::string_view kind;
  std::string_view command;
  std::string_view message;
  json code = nullptr;  // of JSON-RPC, null if the daemon did not say it
  json data = nullptr;
};

int report(const Context& context, const Failure& failure) {
  std::cerr << "gaitctl: ";
  if (!failure.command.empty()) {
    std::cerr << failure.command << (failure.message.starts_with('\n') ? ":" : ": ");
  }
  std::cerr << failure.message << "\n";
  if (context.json) {
    std::cout << json_text({{"error",
                             {{"command", failure.command},
                              {"exit_code", failure.exit_code},
                              {"kind", failure.kind},
                              {"message", failure.message},
                              {"code", failure.code},
                              {"data", failure.data}}}});
  }
  return failure.exit_code;
}

// "walk: text" and "walk.length: text" as "text" and "length: text".
std::string_view without_name(std::string_view line, std::string_view name) {
  if (name.empty() || !line.starts_with(name)) return line;
  const std::string_view rest = line.substr(name.size());
  if (rest.starts_with(": ")) return rest.substr(2);
  return rest.starts_with('.') ? rest.substr(1) : line;
}

}  // namespace

std::string message_for(std::string_view command, std::string_view method,
                        std::string_view message) {
  const bool several = message.find('\n') != std::string_view::npos;
  std::string out;
  while (!message.empty()) {
    const std::size_t end = message.find('\n');
    const std::string_view line = message.substr(0, end);
    const std::string_view shorter = without_name(line, command);
    if (several) out += "\n  ";
    out += shorter.size() < line.size() ? shorter : without_name(line, method);
    message.remove_prefix(end == std::string_view::npos ? message.size() : end + 1);
  }
  return out;
}

int fail(const Context& context, int exit_code, std::string_view command,
         std::string_view message) {
  constexpr std::array<std::string_view, 5> kKinds = {"done", "failed", "usage", "no_daemon",
                                                      "damaged"};
  return report(context, {.exit_code = exit_code,
                          .kind = kKinds[static_cast<std::size_t>(exit_code)],
                          .command = command,
                          .message = message});
}

int fail(const Context& context, std::string_view command, std::string_view method,
         const daemon::RpcError& error) {
  const std::string message = message_for(command, method, error.message);
  if (error.code == kConnectionLost) return fail(context, kNoDaemon, command, message);
  return report(context, {.exit_code = kFailed,
                          .kind = "refused",
                          .command = command,
                          .message = message,
                          .code = error.code,
                          .data = error.data});
}

}  // namespace gaitd::cli
