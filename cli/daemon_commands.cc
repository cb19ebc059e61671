// SPDX-License-Identifier: Apache-2.0
#include "cli/daemon_commands.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/ask.h"
#include "cli/failure.h"
#include "cli/handhold_command.h"
#include "cli/payload_command.h"
#include "cli/pose_command.h"
#include "cli/sim_commands.h"
#include "cli/steps_file.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;

// CLI::PositiveNumber names its upper bound, the largest number of all.
const CLI::Validator kPositiveCount(
    [](std::string& text) {
      const bool positive = text.find_first_not_of("0123456789") == std::string::npos &&
                            text.find_first_not_of('0') != std::string::npos;
      return positive ? "" : "expected a whole number from 1 up, got " + text;
    },
    "", "");

void add_mode(CLI::App* app, Context* context) {
  auto* command = app->add_subcommand(
      "mode", "Set the gait mode; while walking it takes effect at the next step");
  auto mode = std::make_shared<std::string>();
  command->add_option("MODE", *mode, "stand, walk-straight or walk-bent")
      ->required()
      ->check(CLI::IsMember({"stand", "walk-straight", "walk-bent"}));
  command->callback([context, mode] {
    context->action = [context, mode] { return ask(*context, "mode", "mode", {{"mode", *mode}}); };
  });
}

void add_walk(CLI::App* app, Context* context) {
  auto* command = app->add_subcommand(
      "walk", "Walk N advancing steps and one closing step beside the last, which is not counted");
  auto params = std::make_shared<json>(json::object());
  const auto number = [&](const std::string& name, const std::string& description) {
    add_number(command, "--" + name, params, "/" + name, description);
  };
  command
      ->add_option_function<int>(
          "--steps", [params](int value) { (*params)["steps"] = value; },
          "Number of advancing footfalls")
      ->required()
      ->check(kPositiveCount);
  number("length", "Each footfall ahead of the previous one, m; default 0");
  number("lateral", "Each footfall beside the previous one, m, positive to the left; default 0");
  number("width", "Distance between the soles, m; by default as in the standing posture");
  number("turn", "Turn per footfall, rad, positive to the left; default 0");
  number("swing", "Duration of a swing, s; by default gait.swing_duration");
  number("transfer",
         "Duration of a transfer (double support), s; by default gait.transfer_duration");
  command
      ->add_option_function<std::string>(
          "--first", [params](const std::string& value) { (*params)["first"] = value; },
          "Foot that swings first: left or right")
      ->check(CLI::IsMember({"left", "right"}));
  command->callback([context, params] {
    context->action = [context, params] { return ask(*context, "walk", "walk", *params); };
  });
}

void add_steps(CLI::App* app, Context* context) {
  auto* command = app->add_subcommand(
      "steps", "Send explicit footsteps from a YAML or JSON file, while walking too");
  command->footer(
      "The file is a list of footsteps (or a map with it under `footsteps`), poses of the sole\n"
      "frame in the world, m, rad, s:\n"
      "  - {side: left, x: 0.3, y: 0.12, z: 0, yaw: 0, pitch: 0, roll: 0, swing: 0.6,\n"
      "     transfer: 0.25, swing_height: 0.1}");
  auto file = std::make_shared<std::string>();
  auto replace = std::make_shared<bool>(false);
  command->add_option("FILE", *file, "The file, or - for standard input")
      ->required()
      ->type_name("FILE");
  command->add_flag("--replace", *replace, "Drop the footsteps ahead first; else they are queued");
  command->callback([context, file, replace] {
    context->action = [context, file, replace] {
      std::string error;
      const auto params = read_steps(*file, *replace, &error);
      if (!params) return fail(*context, kFailed, "steps", error);
      return ask(*context, "steps", "footsteps", *params);
    };
  });
}

}  // namespace

void add_daemon_commands(CLI::App* app, Context* context) {
  add_plain(app, context, "status", "status", "State, mode, layers with their timings, faults");
  add_plain(app, context, "arm", "arm", "Enable the drives and stand up");
  add_plain(app, context, "disarm", "disarm", "Disable the drives");
  add_plain(app, context, "estop", "estop", "Emergency stop: latches until `reset`");
  add_plain(app, context, "reset", "reset", "Clear a latched fault");
  add_mode(app, context);
  add_walk(app, context);
  add_steps(app, context);
  add_pose_command(app, context);
  add_handhold_command(app, context);
  add_payload_command(app, context);
  add_plain(app, context, "pause", "pause", "Pause after the present step; footsteps are kept");
  add_plain(app, context, "resume", "resume", "Go on after a pause");
  add_plain(app, context, "stop", "stop", "Finish the present step, close the feet and stand");
  add_plain(app, context, "abort", "abort",
            "Drop the footsteps ahead, put the foot down and stand");
  add_plain(app, context, "tare", "tare",
            "Nobody pulls at the robot, which stands: what shows now is zero");
  auto* plugin = app->add_subcommand("plugin", "The control layers of the daemon");
  plugin->require_subcommand(1);
  add_plain(plugin, context, "list", "plugin.list",
            "Every variant of every layer, those in use marked, refused ones with the reason");
  add_sim_commands(app, context);
}

}  // namespace gaitd::cli
