// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/command_line.h"

#include <CLI/CLI.hpp>

#include "daemon/config/paths.h"

namespace gaitd::daemon {

void add_options(CLI::App* app, Options* options, usage::ValueSources* values) {
  app->set_version_flag("--version", GAITD_VERSION " (" GAITD_BUILD ")",
                        "Show the version and exit");
  app->add_option("--config", options->config, "Configuration file (default: gaitd.yaml found)")
      ->type_name("FILE");
  app->add_flag("--no-config", options->no_config,
                "Take no gaitd.yaml: what is not set here or in the scenario is by default")
      ->excludes("--config");
  const auto* backend =
      app->add_option("--backend", options->backend,
                      "Simulation or robot: simbody, mujoco, socketcan, unitree_dds, "
                      "or the path of a plugin")
          ->type_name("NAME|FILE");
  (*values)[backend] = [](const auto&) {
    return std::vector<std::string>{"simbody", "mujoco", "socketcan", "unitree_dds"};
  };
  const auto* robot =
      app->add_option("--robot", options->robot, "Name of a robot or path of a robot.yaml")
          ->type_name("NAME|FILE");
  (*values)[robot] = [](const auto&) { return Paths::detect().robots(); };
  const auto* scenario =
      app->add_option("--scenario", options->scenario, "Scenario to play: name or file")
          ->type_name("NAME|FILE");
  (*values)[scenario] = [](const auto&) { return Paths::detect().scenarios(); };
  app->add_option("--clock", options->clock, "realtime or lockstep")
      ->check(CLI::IsMember({"realtime", "lockstep"}));
  app->add_option("--socket", options->socket, "Unix socket for commands")->type_name("FILE");
  app->add_option("--log", options->log, "Log file (MCAP)")->type_name("FILE");
  app->add_option("--set", options->set, "Any configuration key; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  app->add_flag("--require-rt", options->require_rt, "Refuse to run without all real-time means");
  app->add_flag("--trust", options->trust,
                "Load libraries that a scenario, a robot.yaml or a checked file names by path");
  auto* check = app->add_flag("--check-config", options->check_config,
                              "Check all that a start would check, then exit");
  app->add_option("FILE", options->check_file,
                  "With --check-config: a configuration, robot.yaml or scenario")
      ->needs(check);
  app->footer("Exit codes: 0 done, 1 failed, 2 usage.");
}

usage::ManText man_text() {
  return {
      .name = "gaitd",
      .section = "8",
      .version = GAITD_VERSION,
      .summary = "real-time walking daemon for torque-controlled humanoids",
      .description =
          "gaitd estimates the state of a robot, plans its capture point and computes joint "
          "torques "
          "by whole-body inverse dynamics every period. Each of these layers is a plugin. It "
          "drives "
          "a simulated robot or a real one and takes commands from gaitctl(1) on a Unix socket.\n\n"
          "Without a scenario it stands and waits for commands until SIGINT or SIGTERM; with one "
          "it "
          "plays it and ends. A simulated robot arms itself, a real one has to be told.\n",
      .sections = {
          {"EXIT STATUS",
           "0\tIt ended as asked.\n"
           "1\tSomething could not be read, loaded or opened; every error is on standard error.\n"
           "2\tThe command line is wrong.\n"},
          {"FILES",
           "<prefix>/etc/gaitd/gaitd.yaml\tThe configuration, beside an installed program.\n"
           "/etc/gaitd/gaitd.yaml\tThe configuration, if there is none there.\n"
           "<prefix>/share/gaitd\tRobots and scenarios.\n"
           "<prefix>/lib/gaitd/plugins\tThe layers.\n"
           "/run/gaitd/gaitd.sock\tThe socket, if that folder can be written to.\n"
           "$XDG_RUNTIME_DIR/gaitd.sock\tThe socket otherwise; without a runtime directory "
           "/tmp/gaitd-<uid>/gaitd.sock.\n"},
          {"ENVIRONMENT",
           "GAITD_PATH\tFolders, separated by colons, with robots, scenarios, plugins and "
           "etc/gaitd.yaml of one's own.\n"},
          {"EXAMPLES",
           "    gaitd --log walk.mcap\n"
           "    gaitd --robot my-robot/robot.yaml --check-config\n"
           "    gaitd --set gait.swing_duration=0.7 --clock lockstep --scenario flat-0.35\n"},
          {"SEE ALSO", "gaitctl(1)\n"}}};
}

}  // namespace gaitd::daemon
