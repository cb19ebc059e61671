// SPDX-License-Identifier: Apache-2.0
#include "cli/handhold_command.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/ask.h"
#include "cli/link_options.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;

CLI::Option* add_hand(CLI::App* command, const std::shared_ptr<json>& params,
                      const std::string& description) {
  return command
      ->add_option_function<std::string>(
          "hand", [params](const std::string& hand) { (*params)["hand"] = hand; }, description)
      ->type_name("left|right")
      ->check(CLI::IsMember({"left", "right"}));
}

}  // namespace

void add_handhold_command(CLI::App* app, Context* context) {
  auto* handhold = app->add_subcommand("handhold", "Hands that hold on to something");
  handhold->require_subcommand(1);

  auto* take = handhold->add_subcommand(
      "take", "Press a hand against a surface and count on it from then on");
  auto params = std::make_shared<json>(json::object());
  add_hand(take, params, "Which hand; it is at most a hand's width away from the surface")
      ->required();
  add_vector(take, "--normal", params, "normal",
             "From the surface towards the robot: ahead, to the left, up, as X,Y,Z")
      ->required();
  add_number(take, "--force", params, "/force", "Most that may press on the surface, N")
      ->required();
  add_number(take, "--friction", params, "/friction",
             "Of the hand on the surface; 0.5 if left out");
  take->callback([context, params] {
    context->action = [context, params] {
      return ask(*context, "handhold take", "handhold.take", *params);
    };
  });

  auto* release = handhold->add_subcommand("release", "Let go");
  auto which = std::make_shared<json>(json::object());
  add_hand(release, which, "Which hand; both if left out");
  release->callback([context, which] {
    context->action = [context, which] {
      return ask(*context, "handhold release", "handhold.release", *which);
    };
  });
}

}  // namespace gaitd::cli
