// SPDX-License-Identifier: Apache-2.0
#include "cli/plugin_commands.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "cli/ask.h"
#include "cli/completion_values.h"
#include "cli/failure.h"
#include "cli/plugin_new.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "daemon/config/paths.h"
#include "daemon/config/robot.h"
#include "daemon/conformance/check_plugin.h"
#include "daemon/host/layers.h"
#include "gaitd/sdk/layer_names.h"

namespace gaitd::cli {
namespace {

using daemon::CheckResult;
using daemon::CheckVerdict;
using daemon::PluginReport;
using nlohmann::json;

struct PluginArguments {
  std::string file;
  std::string robot = "atlas";
  double timeout = 60.0;  // s
};

json report_json(const PluginReport& report) {
  json checks = json::array();
  for (const CheckResult& check : report.checks) {
    const char* verdict =
        check.verdict == CheckVerdict::kFail ? "fail" : check_verdict_text(check.verdict);
    checks.push_back({{"name", check.name},
                      {"demands", check.demands},
                      {"verdict", verdict},
                      {"detail", check.detail}});
  }
  json out = {{"file", report.file}, {"pass", report.pass()}, {"checks", std::move(checks)}};
  if (report.descriptor.layer >= 0) {
    out["layer"] = daemon::layer_name(report.descriptor.layer);
    out["variant"] = report.descriptor.id;
    out["version"] = report.descriptor.version;
  }
  return out;
}

std::string counted(int count, const char* noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string report_text(const PluginReport& report) {
  std::ostringstream out;
  for (const CheckResult& check : report.checks) {
    std::string verdict = check_verdict_text(check.verdict);
    verdict.resize(8, ' ');
    std::string name = check.name;
    name.resize(12, ' ');
    out << verdict << ' ' << name << ' ' << check.demands;
    if (!check.detail.empty()) out << "\n         " << std::string(12, ' ') << ' ' << check.detail;
    out << '\n';
  }
  const int failures = report.count(CheckVerdict::kFail);
  const int warnings = report.count(CheckVerdict::kWarning);
  out << (failures == 0 ? "passed: " : "failed: ") << report.file << ": "
      << counted(failures, "failure") << ", " << counted(warnings, "warning") << ", "
      << report.count(CheckVerdict::kPass) << " passed, " << report.count(CheckVerdict::kSkipped)
      << " skipped\n";
  return out.str();
}

int check(const Context& context, const PluginArguments& arguments) {
  const daemon::Paths paths = daemon::Paths::detect();
  const auto robot_file = paths.robot(arguments.robot);
  if (!robot_file) {
    return fail(context, kFailed, "plugin check",
                "no robot '" + arguments.robot + "'; give a robot.yaml or a name with --robot; " +
                    daemon::suggestion(arguments.robot, paths.robots()));
  }
  daemon::Settings settings;
  daemon::Issues issues;
  const auto robot =
      daemon::load_robot(robot_file->string(), daemon::Profile::kSimulation, &settings, &issues);
  if (!robot) return fail(context, kFailed, "plugin check", issues.error_text());
  daemon::CheckOptions options;
  options.timeout = std::chrono::milliseconds(static_cast<long>(1000.0 * arguments.timeout));
  std::optional<Waiting> waiting("trying " + arguments.file);
  const PluginReport report = daemon::check_plugin(arguments.file, robot->model, options);
  waiting.reset();
  std::cout << (context.json ? json_text(report_json(report)) : report_text(report));
  return report.pass() ? kDone : kFailed;
}

// Longer than any swap: loading, shadow, probation.
constexpr std::chrono::minutes kSwapTimeout(2);

CLI::Option* add_layer(CLI::App* command, std::string* layer) {
  const std::vector<std::string> layers(sdk::kLayerNames.begin(), sdk::kLayerNames.end());
  return command->add_option("LAYER", *layer, "Which layer")
      ->required()
      ->check(CLI::IsMember(layers));
}

void add_swap(CLI::App* plugin, Context* context) {
  auto* command = plugin->add_subcommand(
      "swap", "Exchange a layer for another variant, while the robot walks too");
  command->footer(
      "The new layer is loaded, runs beside the one in use, gets its state and takes over between\n"
      "two ticks. The one before stays beside it for a while and takes over again if the new one\n"
      "fails. The command returns when that is over.");
  auto layer = std::make_shared<std::string>();
  auto to = std::make_shared<std::string>();
  add_layer(command, layer.get());
  const auto* variant =
      command
          ->add_option("VARIANT", *to, "An installed variant, or the file of a library (with a /)")
          ->required();
  context->values[variant] = variant_names;
  command->callback([context, layer, to] {
    context->action = [context, layer, to] {
      std::string what = *to;
      // The daemon may have another working directory.
      if (what.find('/') != std::string::npos) what = std::filesystem::absolute(what);
      return ask(*context, "plugin swap", "plugin.swap", {{"layer", *layer}, {"to", what}},
                 kSwapTimeout);
    };
  });
}

void add_rollback(CLI::App* plugin, Context* context) {
  auto* command = plugin->add_subcommand("rollback", "Back to the layer before the last swap");
  auto layer = std::make_shared<std::string>();
  add_layer(command, layer.get());
  command->callback([context, layer] {
    context->action = [context, layer] {
      return ask(*context, "plugin rollback", "plugin.rollback", {{"layer", *layer}}, kSwapTimeout);
    };
  });
}

}  // namespace

void add_plugin_commands(CLI::App* app, Context* context) {
  add_swap(app->get_subcommand("plugin"), context);
  add_rollback(app->get_subcommand("plugin"), context);
  add_plugin_new(app->get_subcommand("plugin"), context);
  auto* command = app->get_subcommand("plugin")->add_subcommand(
      "check", "Try a plugin library, for its author: every demand that it fulfils or fails");
  command->footer(
      "The library is loaded and called in child processes; no daemon is needed. Exit code 0 only "
      "if nothing failed; warnings do not fail.");
  auto arguments = std::make_shared<PluginArguments>();
  command->add_option("FILE", arguments->file, "The library, e.g. build/toe_off/my_variant.so")
      ->required();
  const auto* robot = command
                          ->add_option("--robot", arguments->robot,
                                       "Robot that it is tried with, name or robot.yaml")
                          ->capture_default_str();
  context->values[robot] = [](const auto&) { return daemon::Paths::detect().robots(); };
  command
      ->add_option("--timeout", arguments->timeout,
                   "Time of one child process before it counts as "
                   "hung, s")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  command->callback([context, arguments] {
    context->action = [context, arguments] { return check(*context, *arguments); };
  });
}

}  // namespace gaitd::cli
