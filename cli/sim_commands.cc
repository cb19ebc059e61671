// SPDX-License-Identifier: Apache-2.0
#include "cli/sim_commands.h"

#include <CLI/CLI.hpp>
#include <array>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/ask.h"
#include "cli/completion_values.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;

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
    "", "");

json vector_json(const std::string& text) {
  std::array<double, 3> values{};
  read_vector(text, &values);
  return values;
}

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
  const auto* link =
      push->add_option_function<std::string>(
              "--link", [params](const std::string& value) { (*params)["link"] = value; },
              "Link of the robot")
          ->required();
  context->values[link] = [](const auto&) { return link_names(); };
  push->add_option_function<std::string>(
          "--force",
          [params](const std::string& value) { (*params)["force"] = vector_json(value); },
          "Force in the world, N, as X,Y,Z")
      ->required()
      ->type_name("X,Y,Z")
      ->check(kVector);
  push->add_option_function<double>(
          "--duration", [params](double value) { (*params)["duration"] = value; }, "Duration, s")
      ->required()
      ->check(kPositive);
  push->add_option_function<std::string>(
          "--point",
          [params](const std::string& value) { (*params)["point"] = vector_json(value); },
          "Where it acts in the frame of the link, m, as X,Y,Z; its origin if left out")
      ->type_name("X,Y,Z")
      ->check(kVector);
  push->callback([context, params] {
    context->action = [context, params] { return ask(*context, "sim push", "sim.push", *params); };
  });
  add_plain(sim, context, "reset", "sim.reset", "Put the robot back to the start");
}

}  // namespace gaitd::cli
