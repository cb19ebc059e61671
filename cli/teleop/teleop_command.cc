// SPDX-License-Identifier: Apache-2.0
#include "cli/teleop/teleop_command.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "cli/failure.h"
#include "cli/teleop/console.h"
#include "cli/teleop/pad.h"
#include "cli/teleop/teleop.h"

namespace gaitd::cli {
namespace {

int run(const Context& context, const std::optional<std::string>& gamepad) {
  if (context.json) {
    return fail(context, kUsage, "teleop",
                "it shows the robot to a person and prints no JSON; see gaitctl watch --json");
  }
  if (!teleop::has_keyboard()) {
    return fail(context, kFailed, "teleop",
                "standard input is no terminal, and its keys are what stops the robot; over ssh "
                "use ssh -t, in a script gaitctl drive --forward 0.3 --for 5");
  }
  std::unique_ptr<teleop::Pad> pad;
  if (gamepad) {
    std::string error;
    pad = teleop::open_pad(*gamepad, &error);
    if (!pad) return fail(context, kFailed, "teleop", error);
  }
  teleop::Teleop session(context.socket, std::move(pad));
  if (!session.connect()) return fail(context, kNoDaemon, "teleop", session.why_down());
  const std::string last = session.run();
  if (!last.empty()) std::cout << last << std::endl;
  return kDone;
}

}  // namespace

void add_teleop_command(CLI::App* app, Context* context) {
  auto* command =
      app->add_subcommand("teleop", "Walk the robot by keyboard or gamepad; letting go stops it");
  command->footer(
      "W S A D or arrows walk, Q and E turn, space stops, Esc is the e-stop, + and - change the\n"
      "speed, x ends it; ? shows all keys. It works over ssh: when the connection hangs, the "
      "robot\n"
      "comes to a stand by itself (drive.timeout).");
  auto gamepad = std::make_shared<std::optional<std::string>>();
  auto* option = command
                     ->add_option_function<std::string>(
                         "--gamepad", [gamepad](const std::string& device) { *gamepad = device; },
                         "Drive by a gamepad too, of this machine: that device, or the first one "
                         "found. It moves "
                         "the robot while its LB is held")
                     ->type_name("DEVICE")
                     ->expected(0, 1);
  context->values[option] = [](const auto&) { return teleop::pad_devices(); };
  command->callback([context, gamepad] {
    context->action = [context, gamepad] { return run(*context, *gamepad); };
  });
}

}  // namespace gaitd::cli
