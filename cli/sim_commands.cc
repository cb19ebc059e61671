// SPDX-License-Identifier: Apache-2.0
#include "cli/sim_commands.h"

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/ask.h"
#include "cli/link_options.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;

const CLI::Validator kPositive(
    [](std::string& text) {
      char* end = nullptr;
      const double value = std::strtod(text.c_str(), &end);
      return *end == '\0' && value > 0.0 ? "" : "expected a number above 0, got " + text;
    },
    "", "");

}  // namespace

void add_sim_commands(CLI::App* app, Context* context) {
  auto* sim = app->add_subcommand("sim", "Act on the simulation");
  sim->require_subcommand(1);
  auto* push = sim->add_subcommand("push", "Push a link with a constant force for a while");
  auto params = std::make_shared<json>(json::object());
  add_link(push, context, params, "Link of the robot")->required();
  add_vector(push, "--force", params, "force", "Force in the world, N, as X,Y,Z")->required();
  push->add_option_function<double>(
          "--duration", [params](double value) { (*params)["duration"] = value; }, "Duration, s")
      ->required()
      ->check(kPositive);
  add_vector(push, "--point", params, "point",
             "Where it acts in the frame of the link, m, as X,Y,Z; its origin if left out");
  push->callback([context, params] {
    context->action = [context, params] { return ask(*context, "sim push", "sim.push", *params); };
  });
  auto* load = sim->add_subcommand("load", "Put a mass on a link, or take it off with --mass 0");
  auto what = std::make_shared<json>(json::object());
  add_load(load, context, what);
  load->callback([context, what] {
    context->action = [context, what] { return ask(*context, "sim load", "sim.load", *what); };
  });
  add_plain(sim, context, "reset", "sim.reset", "Put the robot back to the start");
}

}  // namespace gaitd::cli
