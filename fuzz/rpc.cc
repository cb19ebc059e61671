// SPDX-License-Identifier: Apache-2.0
// Lines of clients: parsed, handed to the methods, commands through the bridge to a control thread
// that takes all of them and back.
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>

#include "daemon/config/command_parse.h"
#include "daemon/server/command_bridge.h"
#include "daemon/server/rpc.h"
#include "fuzz/answer.h"
#include "fuzz/lines.h"
#include "fuzz/require.h"

namespace gaitd::daemon {
namespace {

std::unique_ptr<GaitdModel> make_model() {
  auto model = std::make_unique<GaitdModel>();
  model->body_count = 2;
  std::strcpy(model->bodies[0].name, "pelvis");
  std::strcpy(model->bodies[1].name, "utorso");
  return model;
}

struct Server {
  std::unique_ptr<GaitdModel> model = make_model();
  CommandBridge bridge;
  Methods methods;

  Server() {
    add_command_methods(&methods, &bridge,
                        [this](const std::string& method,
                               const nlohmann::json& params) -> std::variant<Command, RpcError> {
                          std::string error;
                          if (auto command = parse_command(method, params, *model, &error))
                            return *command;
                          fuzz::require(!error.empty(), "a refusal names its reason");
                          return RpcError{rpc_code::kInvalidParams, error};
                        });
    methods.add_snapshot("status", [] { return nlohmann::json{{"state", "standing"}}; });
  }
};

void check_command(const Command& command) {
  fuzz::require(std::isfinite(command.walk.length) && std::isfinite(command.walk.turn),
                "a walk is finite");
  fuzz::require(command.footstep_count >= 0 &&
                    command.footstep_count <= static_cast<int>(command.footsteps.size()),
                "the count of footsteps fits");
  for (int i = 0; i < command.footstep_count; ++i) {
    for (const double value : command.footsteps[i].pose.position) {
      fuzz::require(std::isfinite(value), "a footstep is finite");
    }
    for (const double value : command.footsteps[i].pose.orientation) {
      fuzz::require(std::isfinite(value), "an orientation is finite");
    }
  }
}

void handle(Server* server, std::string_view line) {
  int answers = 0;
  handle_line(server->methods, RpcLimits{}, Caller{}, line, [&](const std::string& answer) {
    ++answers;
    fuzz::check_answer(answer);
  });
  static Command command;
  bool taken = true;
  while (server->bridge.waiting() && taken) {
    for (taken = false; server->bridge.try_pop(command); taken = true) {
      check_command(command);
      CommandReply reply;
      reply.request = command.request;
      reply.accepted = true;
      server->bridge.push(reply);
    }
    server->bridge.poll(CommandBridge::Clock::now());
  }
  fuzz::require(answers <= 1, "at most one answer to a line");
  fuzz::require(!server->bridge.waiting(), "every command is answered");
}

}  // namespace
}  // namespace gaitd::daemon

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static auto* server = new gaitd::daemon::Server;
  gaitd::fuzz::for_each_line(data, size,
                             [](std::string_view line) { gaitd::daemon::handle(server, line); });
  return 0;
}
