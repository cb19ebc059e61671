// SPDX-License-Identifier: Apache-2.0
// gaitd-fake-robot: a simulated robot on CAN buses, for gaitd --backend socketcan.
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/fake_robot/fake_robot.h"
#include "daemon/config/paths.h"
#include "daemon/config/robot.h"
#include "gaitd/sim/config.h"
#include "simbody_physics.h"

namespace {

volatile std::sig_atomic_t stopping = 0;
void stop(int) { stopping = 1; }

int fail(const std::string& text) {
  std::fprintf(stderr, "gaitd-fake-robot: %s\n", text.c_str());
  return 1;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  std::string robot_name = "atlas";
  std::string wiring_file;
  std::string report_file;
  std::string world = R"({"terrain": {"ground_z": 0.0}})";
  std::vector<std::string> fault_texts;
  gaitd::cli::FakeRobotOptions options;
  CLI::App app("A simulated robot on CAN buses", "gaitd-fake-robot");
  app.add_option("--robot", robot_name, "name, or path of a robot.yaml");
  app.add_option("--can", wiring_file, "wiring in place of the robot's, beside its robot.yaml");
  app.add_option("--period", options.period, "s of simulated time per cycle of commands");
  app.add_option("--world", world, "configuration of the simulation, JSON");
  app.add_option("--motor-timeout", options.motor_timeout, "s, that the registers say");
  app.add_option("--stall-time", options.stall_time,
                 "s of wall time without commands after which a motor switches off");
  app.add_option("--patience", options.patience,
                 "s of wall time after which a cycle ends without the commands that miss");
  app.add_option("--fault", fault_texts, "KIND[:TARGET][=VALUE][@TIME], any number");
  app.add_option("--report", report_file, "written at the end, JSON");
  CLI11_PARSE(app, argc, argv);

  std::string error;
  for (const std::string& text : fault_texts) {
    const auto fault = gaitd::cli::parse_fault(text, &error);
    if (!fault) return fail(error);
    options.faults.push_back(*fault);
  }
  using namespace gaitd::daemon;  // NOLINT(google-build-using-namespace): of this function
  const auto file = Paths::detect().robot(robot_name);
  if (!file) return fail("no robot '" + robot_name + "'");
  Issues issues;
  auto robot = load_robot(file->string(), Profile::kSimulation, nullptr, &issues);
  if (robot) {
    const auto wiring = wiring_file.empty() ? robot->can : make_scalar(wiring_file, {});
    robot->can = load_wiring(wiring, file->parent_path().string(), &issues);
  }
  if (!issues.ok()) return fail(issues.error_text());
  if (!robot->can) return fail(file->string() + ": expected a can: section");
  std::vector<std::string> errors;
  gaitd::can::Wiring wiring =
      gaitd::can::parse_wiring(to_json(*robot->can).dump(), robot->model, options.period, &errors);
  const gaitd::sim::Config config =
      gaitd::sim::parse_config(world, robot->model, options.period, &errors);
  if (!errors.empty()) return fail(joined(errors));

  std::signal(SIGTERM, stop);
  std::signal(SIGINT, stop);
  gaitd::cli::FakeRobot fake(
      robot->model, std::move(wiring),
      std::make_unique<gaitd::sim::Plant>(robot->model, config, options.period,
                                          gaitd::sim::SimbodyPhysics::make),
      options);
  if (!fake.start(&error)) return fail(error);
  std::printf("ready\n");
  std::fflush(stdout);
  while (stopping == 0) fake.serve(0.05);
  fake.serve(0.0);  // what is on the buses already
  const std::string report = fake.report().dump(2) + "\n";
  if (report_file.empty()) {
    std::fputs(report.c_str(), stdout);
  } else {
    std::ofstream(report_file) << report;
  }
  return 0;
}
