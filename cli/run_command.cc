// SPDX-License-Identifier: Apache-2.0
#include "cli/run_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "cli/completion_values.h"
#include "cli/failure.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "cli/scenario_run.h"
#include "cli/setting_option.h"
#include "cli/table.h"
#include "cli/terminal.h"
#include "daemon/config/paths.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

struct RunArguments {
  std::vector<std::string> scenarios;
  std::vector<std::string> settings;
  std::string log;
  std::string robot;
  bool trust = false;
  bool verbose = false;
};

// One line for each of several scenarios, then how many passed.
void print_summary(const std::vector<RunReport>& reports) {
  std::vector<std::vector<std::string>> rows;
  std::size_t passed = 0;
  for (const RunReport& report : reports) {
    passed += report.pass() ? 1 : 0;
    rows.push_back({report.scenario, report.pass() ? "PASS" : "FAIL", what_failed(report)});
  }
  std::cout << "\n" << table({"scenario", "verdict", "what failed"}, rows);
  const bool all = passed == reports.size();
  print_colored(all, all ? "all " + std::to_string(passed) + " passed"
                         : std::to_string(reports.size() - passed) + " of " +
                               std::to_string(reports.size()) + " FAILED");
  std::cout << std::endl;
}

int run(const Context& context, const RunArguments& arguments) {
  std::error_code ignored;
  if (arguments.scenarios.size() > 1 && !arguments.log.empty() && !arguments.log.ends_with('/') &&
      !fs::is_directory(arguments.log, ignored)) {
    return fail(
        context, kUsage, "run",
        "--log " + arguments.log + ": one file for several scenarios; give a folder (ending in /)");
  }
  const RunOptions options{gaitd_program(), arguments.settings, arguments.log, arguments.trust,
                           arguments.robot};
  std::vector<RunReport> reports;
  for (const std::string& scenario : arguments.scenarios) {
    reports.push_back(run_with_progress(scenario, options, scenario));
    const RunReport& report = reports.back();
    if (!context.json) {
      std::cout << (reports.size() > 1 ? "\n" : "")
                << report_text(report, arguments.verbose, output_columns());
      print_colored(report.pass(), verdict_line(report));
      std::cout << std::endl;
    }
    if (report.interrupted) break;
  }
  const auto any = [&](auto is) { return std::any_of(reports.begin(), reports.end(), is); };
  const bool pass = !any([](const RunReport& report) { return !report.pass(); });
  const bool damaged = any([](const RunReport& report) { return report.damaged; });
  const bool interrupted = any([](const RunReport& report) { return report.interrupted; });
  if (context.json) {
    nlohmann::json list = nlohmann::json::array();
    for (const RunReport& report : reports) list.push_back(report_json(report));
    std::cout << json_text({{"pass", pass}, {"scenarios", list}});
  } else if (reports.size() > 1) {
    print_summary(reports);
  }
  if (interrupted) return kInterrupted;
  if (damaged) return kDamaged;
  return pass ? kDone : kFailed;
}

}  // namespace

void add_run_command(CLI::App* app, Context* context) {
  auto* command = app->add_subcommand(
      "run", "Play scenarios on a private gaitd in lockstep and judge what the logs show");
  command->footer(
      "Exit code 0 only if every expectation of every scenario holds; 4 if a log is damaged.");
  auto arguments = std::make_shared<RunArguments>();
  const auto* scenario =
      command
          ->add_option("SCENARIO", arguments->scenarios,
                       "Name of a scenario (flat-0.35), or the path of a scenario file")
          ->required()
          ->type_name("NAME|FILE");
  context->values[scenario] = [](const auto&) { return daemon::Paths::detect().scenarios(); };
  const auto* robot =
      command
          ->add_option(
              "--robot", arguments->robot,
              "In place of the robot of the scenarios: a name, or the path of a robot.yaml")
          ->type_name("NAME|FILE");
  context->values[robot] = [](const auto&) { return daemon::Paths::detect().robots(); };
  add_settings(command, context, &arguments->settings,
               "Any key of the configuration or the scenario, the value in YAML; may be repeated");
  const auto* backend =
      command
          ->add_option_function<std::string>(
              "--backend",
              [arguments](const std::string& name) {
                arguments->settings.push_back("backend=" + name);
              },
              "The simulation to play them in: simbody, mujoco, or the path of a plugin")
          ->type_name("NAME|FILE");
  context->values[backend] = [](const auto&) { return simulation_names(); };
  command
      ->add_option("--log", arguments->log,
                   "Log file, or folder for several (ending in /); by default a new file in "
                   "$XDG_STATE_HOME/gaitd/logs (~/.local/state/gaitd/logs). The output of gaitd "
                   "goes beside it as FILE.txt")
      ->type_name("FILE|FOLDER/");
  command->add_flag("-v,--verbose", arguments->verbose, "Show every figure of the walk too");
  command->add_flag("--trust", arguments->trust,
                    "Load libraries that a scenario or its robot.yaml names by path");
  command->callback([context, arguments] {
    context->action = [context, arguments] { return run(*context, *arguments); };
  });
}

}  // namespace gaitd::cli
