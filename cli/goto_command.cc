// SPDX-License-Identifier: Apache-2.0
#include "cli/goto_command.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/ask.h"

namespace gaitd::cli {

void add_goto_command(CLI::App* app, Context* context) {
  auto* command = app->add_subcommand(
      "goto", "Plan footsteps to a place and walk there, in the place of the footsteps ahead");
  command->footer(
      "The footsteps are planned over the height map that goto.height_map names, over the terrain "
      "of\n"
      "the scenario that is played, or else over level ground. Where there is no way it says why.");
  auto params = std::make_shared<nlohmann::json>(nlohmann::json::object());
  const auto number = [&](const char* name, const char* key, const char* description) {
    return add_number(command, name, params, std::string("/") + key, description);
  };
  number("X", "x", "Where the middle of the feet is to be, m in the world")->required();
  number("Y", "y", "Likewise")->required();
  number("YAW", "yaw", "Heading there, rad; without it as it comes");
  command->callback([context, params] {
    context->action = [context, params] { return ask(*context, "goto", "goto", *params); };
  });
}

}  // namespace gaitd::cli
