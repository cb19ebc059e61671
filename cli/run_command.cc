// SPDX-License-Identifier: Apache-2.0
#include "cli/run_command.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "cli/failure.h"
#include "cli/print.h"
#include "cli/scenario_run.h"
#include "daemon/config/paths.h"
#include "daemon/config/printable.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kInterrupted = 130;  // as a shell reports a program that SIGINT ended

struct Arguments {
  std::vector<std::string> scenarios;
  std::vector<std::string> settings;
  std::string log;
  bool trust = false;
};

void show_progress(const std::string& scenario, double time, double duration) {
  std::fprintf(stderr, "\r%s: %.1f of %.1f s simulated\033[K", daemon::printable(scenario).c_str(),
               time, duration);
  std::fflush(stderr);
}

int run(const Context& context, const Arguments& arguments) {
  std::error_code ignored;
  if (arguments.scenarios.size() > 1 && !arguments.log.empty() && !arguments.log.ends_with('/') &&
      !fs::is_directory(arguments.log, ignored)) {
    return fail(
        context, kUsage, "run",
        "--log " + arguments.log + ": one file for several scenarios; give a folder (ending in /)");
  }
  const RunOptions options{gaitd_program(), arguments.settings, arguments.log, arguments.trust};
  const bool terminal = isatty(STDERR_FILENO) != 0;
  bool pass = true;
  bool interrupted = false;
  bool damaged = false;
  std::size_t done = 0;
  nlohmann::json reports = nlohmann::json::array();
  for (const std::string& scenario : arguments.scenarios) {
    if (!terminal) std::cerr << "running " << scenario << std::endl;
    const RunReport report =
        run_scenario(scenario, options, terminal ? Progress(show_progress) : Progress());
    if (terminal) std::fputs("\r\033[K", stderr);
    pass &= report.pass();
    damaged |= report.damaged;
    ++done;
    if (context.json) {
      reports.push_back(report_json(report));
    } else {
      std::cout << (done > 1 ? "\n" : "") << report_text(report) << std::flush;
    }
    interrupted = report.interrupted;
    if (interrupted) break;
  }
  if (context.json) std::cout << json_text({{"pass", pass}, {"scenarios", reports}});
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
  auto arguments = std::make_shared<Arguments>();
  const auto* scenario =
      command
          ->add_option("SCENARIO", arguments->scenarios,
                       "Name of a scenario (flat-0.35), or the path of a scenario file")
          ->required()
          ->type_name("NAME|FILE");
  context->values[scenario] = [] { return daemon::Paths::detect().scenarios(); };
  command
      ->add_option(
          "--set", arguments->settings,
          "Any key of the configuration or the scenario, the value in YAML; may be repeated")
      ->type_name("KEY=VALUE")
      ->take_all()
      ->expected(1);
  const auto* backend =
      command
          ->add_option_function<std::string>(
              "--backend",
              [arguments](const std::string& name) {
                arguments->settings.push_back("backend=" + name);
              },
              "The simulation to play them in: simbody, mujoco, or the path of a plugin")
          ->type_name("NAME|FILE");
  context->values[backend] = [] { return std::vector<std::string>{"simbody", "mujoco"}; };
  command
      ->add_option("--log", arguments->log,
                   "Log file, or folder for several (ending in /); by default a new file in "
                   "$XDG_STATE_HOME/gaitd/logs (~/.local/state/gaitd/logs). The output of gaitd "
                   "goes beside it as .txt")
      ->type_name("FILE|FOLDER/");
  command->add_flag("--trust", arguments->trust,
                    "Load libraries that a scenario or its robot.yaml names by path");
  command->callback([context, arguments] {
    context->action = [context, arguments] { return run(*context, *arguments); };
  });
}

}  // namespace gaitd::cli
