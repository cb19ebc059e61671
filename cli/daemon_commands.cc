// SPDX-License-Identifier: Apache-2.0
#include "cli/daemon_commands.h"

#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "cli/print.h"
#include "cli/rpc_client.h"
#include "cli/steps_file.h"
#include "daemon/server/socket_path.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;

// Waits, at most 15 s, until the robot has the posture in which it takes commands.
void wait_until_ready(RpcClient* client) {
  using std::chrono::milliseconds;
  for (milliseconds waited{0}; waited < milliseconds(15000); waited += milliseconds(50)) {
    std::this_thread::sleep_for(milliseconds(50));
    const daemon::RpcResult status = client->call("status", nullptr);
    const json* value = std::get_if<json>(&status);
    if (value == nullptr || !value->is_object()) return;
    if (value->value("state", json()) != "readying") return;
  }
}

// Sends the request and prints the answer; returns the exit code.
int ask(const Context& context, const std::string& method, const json& params) {
  std::string error;
  const auto client = RpcClient::connect(
      daemon::connect_paths(context.socket, daemon::SocketPlaces::of_this_process()), &error);
  if (!client) {
    std::cerr << "gaitctl: " << error << "\n";
    return kNoDaemon;
  }
  const daemon::RpcResult result = client->call(method, params);
  if (const auto* failure = std::get_if<daemon::RpcError>(&result)) {
    std::cerr << "gaitctl: " << method << ": " << failure->message << "\n";
    if (context.json) {
      std::cout << json_text(
          {{"error",
            {{"code", failure->code}, {"message", failure->message}, {"data", failure->data}}}});
    }
    return kFailed;
  }
  if (method == "arm" || method == "sim.reset") wait_until_ready(client.get());
  const json& value = std::get<json>(result);
  std::cout << (context.json ? json_text(value) : result_text(method, value));
  return kDone;
}

// A command without arguments of its own.
void add_plain(CLI::App* app, Context* context, const std::string& name, const std::string& method,
               const std::string& description) {
  app->add_subcommand(name, description)->callback([context, method] {
    context->action = [context, method] { return ask(*context, method, nullptr); };
  });
}

// "1,2.5,-3" as three numbers; an error text for CLI11 otherwise.
std::string read_vector(const std::string& text, std::array<double, 3>* out) {
  const char* at = text.c_str();
  for (std::size_t i = 0; i < 3; ++i) {
    char* end = nullptr;
    (*out)[i] = std::strtod(at, &end);
    const char expected = i < 2 ? ',' : '\0';
    if (end == at || *end != expected) return "expected X,Y,Z (three numbers), got " + text;
    at = end + 1;
  }
  return "";
}

const CLI::Validator kVector(
    [](std::string& text) {
      std::array<double, 3> ignored;
      return read_vector(text, &ignored);
    },
    "X,Y,Z");

json vector_json(const std::string& text) {
  std::array<double, 3> values{};
  read_vector(text, &values);
  return values;
}

void add_mode(CLI::App* app, Context* context) {
  auto* command = app->add_subcommand(
      "mode", "Set the gait mode; while walking it takes effect at the next step");
  auto mode = std::make_shared<std::string>();
  command->add_option("MODE", *mode, "stand, walk-straight or walk-bent")
      ->required()
      ->check(CLI::IsMember({"stand", "walk-straight", "walk-bent"}));
  command->callback([context, mode] {
    context->action = [context, mode] { return ask(*context, "mode", {{"mode", *mode}}); };
  });
}

void add_walk(CLI::App* app, Context* context) {
  auto* command = app->add_subcommand(
      "walk", "Walk N advancing steps and one closing step beside the last, which is not counted");
  auto params = std::make_shared<json>(json::object());
  // Only what was given is sent: the daemon knows the defaults of the robot.
  const auto number = [&](const std::string& option, const std::string& key,
                          const std::string& description) {
    return command->add_option_function<double>(
        option, [params, key](double value) { (*params)[key] = value; }, description);
  };
  command
      ->add_option_function<int>(
          "--steps", [params](int value) { (*params)["steps"] = value; },
          "Number of advancing footfalls")
      ->required()
      ->check(CLI::PositiveNumber);
  number("--length", "length", "Each footfall ahead of the previous one, m");
  number("--lateral", "lateral", "Each footfall beside the previous one, m, positive to the left");
  number("--width", "width", "Distance between the soles, m");
  number("--turn", "turn", "Turn per footfall, rad, positive to the left");
  number("--swing", "swing", "Duration of a swing, s");
  number("--transfer", "transfer", "Duration of a transfer (double support), s");
  command
      ->add_option_function<std::string>(
          "--first", [params](const std::string& value) { (*params)["first"] = value; },
          "Foot that swings first: left or right")
      ->check(CLI::IsMember({"left", "right"}));
  command->callback([context, params] {
    context->action = [context, params] { return ask(*context, "walk", *params); };
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
  command->add_option("FILE", *file, "The file, or - for standard input")->required();
  command->add_flag("--replace", *replace, "Drop the footsteps ahead first; else they are queued");
  command->callback([context, file, replace] {
    context->action = [context, file, replace] {
      std::string error;
      const auto params = read_steps(*file, *replace, &error);
      if (params) return ask(*context, "footsteps", *params);
      std::cerr << "gaitctl: steps:\n" << error << "\n";
      return kUsage;
    };
  });
}

void add_sim(CLI::App* app, Context* context) {
  auto* sim = app->add_subcommand("sim", "Act on the simulation");
  sim->require_subcommand(1);
  auto* push = sim->add_subcommand("push", "Push a link with a constant force for a while");
  auto params = std::make_shared<json>(json::object());
  push->add_option_function<std::string>(
          "--link", [params](const std::string& value) { (*params)["link"] = value; },
          "Link of the robot")
      ->required();
  push->add_option_function<std::string>(
          "--force",
          [params](const std::string& value) { (*params)["force"] = vector_json(value); },
          "Force in the world, N, as X,Y,Z")
      ->required()
      ->check(kVector);
  push->add_option_function<double>(
          "--duration", [params](double value) { (*params)["duration"] = value; }, "Duration, s")
      ->required()
      ->check(CLI::PositiveNumber);
  push->add_option_function<std::string>(
          "--point",
          [params](const std::string& value) { (*params)["point"] = vector_json(value); },
          "Where it acts in the frame of the link, m, as X,Y,Z; its origin if left out")
      ->check(kVector);
  push->callback([context, params] {
    context->action = [context, params] { return ask(*context, "sim.push", *params); };
  });
  add_plain(sim, context, "reset", "sim.reset", "Put the robot back to the start");
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
  add_plain(app, context, "pause", "pause", "Pause after the present step, footsteps are kept");
  add_plain(app, context, "resume", "resume", "Go on after a pause");
  add_plain(app, context, "stop", "stop", "Finish the present step, close the feet and stand");
  add_plain(app, context, "abort", "abort",
            "Drop the footsteps ahead, put the foot down and stand");
  auto* plugin = app->add_subcommand("plugin", "The control layers of the daemon");
  plugin->require_subcommand(1);
  add_plain(plugin, context, "list", "plugin.list",
            "Every variant of every layer, those in use marked, refused ones with the reason");
  add_sim(app, context);
}

}  // namespace gaitd::cli
