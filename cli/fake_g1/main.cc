// SPDX-License-Identifier: Apache-2.0
// gaitd-fake-g1: a simulated Unitree G1 on DDS, for gaitd --backend unitree_dds.
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "cli/fake_g1/fake_g1.h"
#include "daemon/config/paths.h"
#include "daemon/config/robot.h"
#include "gaitd/sim/config.h"
#include "simbody_physics.h"

namespace {

volatile std::sig_atomic_t stopping = 0;
void stop(int) { stopping = 1; }

int fail(const std::string& text) {
  std::fprintf(stderr, "gaitd-fake-g1: %s\n", text.c_str());
  return 1;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  using gaitd::cli::g1::Silence;
  std::string robot_name = "g1";
  std::string report_file;
  std::string world = R"({"terrain": {"ground_z": 0.0}})";
  std::vector<std::string> fault_texts;
  gaitd::cli::g1::Options options;
  CLI::App app("A simulated Unitree G1 on DDS", "gaitd-fake-g1");
  app.add_option("--robot", robot_name, "name, or path of a robot.yaml");
  app.add_option("--interface", options.interface, "network interface")->capture_default_str();
  app.add_option("--domain", options.domain, "of DDS")->capture_default_str();
  app.add_flag("--lockstep", options.lockstep, "a period for every command, and none without");
  app.add_option("--patience", options.patience,
                 "s of wall time after which a lock step goes on without a command");
  app.add_option("--period", options.period, "s of simulated time per period");
  app.add_option("--rate", options.rate, "Hz, states in real time; the real robot: 1041.7");
  app.add_option("--machine", options.machine, "mode_machine")->capture_default_str();
  app.add_option("--mode", options.mode, "built-in walking that commands until it is released");
  app.add_option("--silence", options.silence, "s without a command until the robot reacts");
  app.add_option("--on-silence", options.reaction, "damp, limp or hold")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Silence>{
          {"damp", Silence::kDamp}, {"limp", Silence::kLimp}, {"hold", Silence::kHold}}));
  app.add_option("--delay", options.delay, "s between a command and its effect");
  app.add_option("--gain", options.gain, "of every torque that a motor is told");
  app.add_option("--rate-noise", options.rate_noise, "rad/s, sigma of dq");
  app.add_option("--force-bias", options.force_bias, "m/s^2 on each axis of an accelerometer");
  app.add_option("--feet", options.feet, "topic of foot force sensors, which a real one lacks");
  app.add_option("--world", world, "configuration of the simulation, JSON");
  app.add_option("--fault", fault_texts, "KIND[:TARGET][=VALUE][@TIME], any number");
  app.add_option("--report", report_file, "written at the end, JSON");
  CLI11_PARSE(app, argc, argv);

  std::string error;
  for (const std::string& text : fault_texts) {
    const auto fault = gaitd::cli::g1::parse_fault(text, &error);
    if (!fault) return fail(error);
    options.faults.push_back(*fault);
  }
  using namespace gaitd::daemon;  // NOLINT(google-build-using-namespace): of this function
  const auto file = Paths::detect().robot(robot_name);
  if (!file) return fail("no robot '" + robot_name + "'");
  Issues issues;
  const auto robot = load_robot(file->string(), Profile::kSimulation, nullptr, &issues);
  if (!issues.ok()) return fail(issues.error_text());
  for (int i = 0; i < robot->model.joint_count; ++i) {
    const char* name = robot->model.joints[i].name;
    if (gaitd::unitree::wire_index(name) < 0) {
      return fail(std::string("a G1 has no joint ") + name);
    }
  }
  std::vector<std::string> errors;
  const gaitd::sim::Config config =
      gaitd::sim::parse_config(world, robot->model, options.period, &errors);
  if (!errors.empty()) return fail(joined(errors));

  std::signal(SIGTERM, stop);
  std::signal(SIGINT, stop);
  try {
    gaitd::cli::g1::FakeG1 fake(
        robot->model,
        std::make_unique<gaitd::sim::Plant>(robot->model, config, options.period,
                                            gaitd::sim::SimbodyPhysics::make),
        options);
    std::printf("ready\n");
    std::fflush(stdout);
    while (stopping == 0) fake.serve();
    const std::string report = fake.report().dump(2) + "\n";
    if (report_file.empty()) {
      std::fputs(report.c_str(), stdout);
    } else {
      std::ofstream(report_file) << report;
    }
  } catch (const std::exception& problem) {
    return fail(problem.what());
  }
  return 0;
}
