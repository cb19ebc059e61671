// SPDX-License-Identifier: Apache-2.0
#include "cli/calibrate/calibrate_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/calibrate/calibration_text.h"
#include "cli/calibrate/live_motions.h"
#include "cli/calibrate/motions.h"
#include "cli/failure.h"
#include "cli/log_damage.h"
#include "cli/print.h"
#include "cli/private_directory.h"
#include "cli/progress.h"
#include "cli/scenario_run.h"
#include "cli/setting_option.h"
#include "daemon/config/daemon_config.h"
#include "daemon/config/names.h"
#include "daemon/config/paths.h"
#include "daemon/config/robot.h"
#include "daemon/replay/robot_of_log.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCommand = "calibrate";
constexpr std::size_t kFewestPostures = 6;

struct CalibrateArguments {
  std::vector<std::string> logs;  // that were given
  std::string output;
  std::string motions;        // empty: made for the robot
  std::string robot;          // that is simulated, or whose motions are written
  std::string write_motions;  // file
  std::vector<std::string> settings;
  std::string simulated_log;
  bool trust = false;
  bool simulate = false;
  calibrate::Prior prior;
};

int save_text(const Context& context, const std::string& file, const std::string& text) {
  std::error_code ignored;
  const fs::path folder = fs::path(file).parent_path();
  if (!folder.empty()) fs::create_directories(folder, ignored);
  const std::string fresh = file + ".new";
  std::ofstream out(fresh);
  out << text;
  out.close();
  std::error_code error;
  if (out) fs::rename(fresh, file, error);
  if (out && !error) return kDone;
  fs::remove(fresh, ignored);
  return fail(context, kFailed, kCommand,
              file + ": cannot be written; choose a place with -o FILE");
}

// Beside the robot.yaml of the robot, unless the user says where.
std::string output_of(const CalibrateArguments& arguments, const daemon::Robot& robot) {
  if (!arguments.output.empty()) return arguments.output;
  const fs::path folder = fs::path(robot.file).parent_path() / "calibration";
  return (folder / "measured.yaml").string();
}

calibrate::Result measure(const daemon::Robot& robot, const calibrate::Recording& recording,
                          const calibrate::Prior& prior) {
  calibrate::Result result;
  result.hanging = static_cast<int>(recording.hanging.size());
  result.known = robot.calibration;
  daemon::Calibration known = robot.calibration;
  if (result.hanging > 0) {
    result.feet = calibrate::foot_offsets(robot.model, known, recording.hanging);
  }
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    if (result.hanging == 0) result.feet[side].value = known.feet[side];
    known.feet[side] = result.feet[side].value;
  }
  result.identified = calibrate::identify(robot.model, known, recording, prior);
  for (std::size_t i = 0; i < result.identified.zeros.joints.size(); ++i) {
    known.joints[result.identified.zeros.joints[i]].zero =
        result.identified.zeros.value[static_cast<Eigen::Index>(i)];
  }
  result.drives = calibrate::drive_errors(robot.model, known, recording.tests);
  for (std::size_t j = 0; j < result.drives.size(); ++j) {
    calibrate::DriveErrors& drive = result.drives[j];
    const daemon::JointCalibration& kind = known.joints[j];
    if (drive.measured) continue;  // else what is known of its kind stays
    drive.measured = kind.torque_bias != 0.0 || kind.coulomb > 0.0 || kind.viscous > 0.0;
    drive.bias = kind.torque_bias;
    drive.coulomb = kind.coulomb;
    drive.viscous = kind.viscous;
  }
  return result;
}

// Why a robot cannot be measured; empty: it can.
std::string what_lacks(const GaitdModel& model) {
  const std::string name = model.name;
  if (model.imu_count < 1) return name + ": it has no IMU";
  for (const GaitdFoot& foot : model.feet) {
    if (foot.force_sensor.body >= 0) continue;
    return name +
           ": its feet have no force sensors, and what they read is what its zeros are found from; "
           "measure them in a jig, and write them into a file as docs/configuration.md shows";
  }
  return "";
}

// `growing`: gaitd still writes the log, so that it has no end is no damage.
int estimate(const Context& context, const CalibrateArguments& arguments,
             const std::vector<std::string>& files, bool growing = false) {
  std::string error;
  std::vector<std::unique_ptr<daemon::LogReader>> logs;
  for (const std::string& part : files) {
    logs.push_back(daemon::LogReader::open(part, &error));
    if (logs.back() == nullptr) return fail(context, kFailed, kCommand, error);
  }
  const std::string& file = files.front();
  const auto robot = daemon::robot_of_log(*logs.front(), nullptr, &error);
  if (!robot) return fail(context, kFailed, kCommand, file + ": " + error);
  if (const std::string lacking = what_lacks(robot->model); !lacking.empty()) {
    return fail(context, kFailed, kCommand, lacking);
  }
  const auto recording = calibrate::read_recording(logs, robot->model, &error);
  if (!recording) return fail(context, kFailed, kCommand, file + ": " + error);
  if (recording->postures.size() < kFewestPostures) {
    return fail(context, kFailed, kCommand,
                file + ": expected at least " + std::to_string(kFewestPostures) +
                    " postures in which the robot stands still, got " +
                    std::to_string(recording->postures.size()) +
                    "; let it take those of `gaitctl calibrate --write-motions FILE`");
  }
  std::optional<Waiting> waiting("estimating the calibration");
  const calibrate::Result result = measure(*robot, *recording, arguments.prior);
  waiting.reset();
  const auto is_damaged = [growing](const std::unique_ptr<daemon::LogReader>& log) {
    return log->damaged() > 0 ||
           (!growing && (log->damage().any() || log->changed() || !log->sealed()));
  };
  const auto damaged = std::ranges::find_if(logs, is_damaged);
  const std::string output = output_of(arguments, *robot);
  if (const int failed = save_text(
          context, output, calibration_yaml(robot->model, result, fs::path(file).filename()))) {
    return failed;
  }
  if (context.json) {
    nlohmann::json json = summary_json(robot->model, result);
    json["file"] = output;
    if (damaged != logs.end()) add_damage(**damaged, &json);
    std::cout << json_text(json);
  } else {
    std::cout << summary(robot->model, result) << "written: " << output << "\n";
  }
  return damaged != logs.end() ? tell_damage(kCommand, **damaged, kDone) : kDone;
}

// The robot of --robot, of `--set robot=`, or that which gaitd has by default.
std::string robot_named(const CalibrateArguments& arguments) {
  constexpr std::string_view kKey = "robot=";
  if (!arguments.robot.empty()) return arguments.robot;
  std::string robot = daemon::DaemonConfig().robot;
  for (const std::string& setting : arguments.settings) {
    if (setting.starts_with(kKey)) robot = setting.substr(kKey.size());
  }
  return robot;
}

// The motions of that robot as the text of a scenario; nothing, with why in `error`.
std::optional<std::string> motions_of(const std::string& name, std::string* error) {
  const daemon::Paths paths = daemon::Paths::detect();
  const auto file = paths.robot(name);
  if (!file) {
    *error = "no robot '" + name + "'; give a robot.yaml or a name with --robot; " +
             daemon::suggestion(name, paths.robots());
    return std::nullopt;
  }
  daemon::Settings settings;
  daemon::Issues issues;
  const auto robot =
      daemon::load_robot(file->string(), daemon::Profile::kSimulation, &settings, &issues);
  if (!robot) {
    *error = issues.error_text();
    return std::nullopt;
  }
  *error = what_lacks(robot->model);
  if (!error->empty()) return std::nullopt;
  return calibrate::motions_yaml(robot->model, fs::absolute(*file).string());
}

int simulate(const Context& context, const CalibrateArguments& arguments) {
  const PrivateDirectory directory;
  std::string motions = arguments.motions;
  if (motions.empty()) {
    std::string error;
    const auto text = motions_of(robot_named(arguments), &error);
    if (!text) return fail(context, kFailed, kCommand, error);
    motions = directory.path() + "/calibration.yaml";
    if (const int failed = save_text(context, motions, *text)) return failed;
  }
  // It walks in other episodes than the one in which it is measured.
  std::vector<std::string> settings{"sensors.episode=1"};
  settings.insert(settings.end(), arguments.settings.begin(), arguments.settings.end());
  const RunOptions options{gaitd_program(), settings, arguments.simulated_log, arguments.trust,
                           arguments.robot};
  const std::string name = arguments.motions.empty() ? "calibration" : arguments.motions;
  const RunReport report = run_with_progress(motions, options, name);
  if (!report.pass()) {
    std::cerr << report_text(report, true, 0);
    return fail(context, kFailed, kCommand, name + ": the robot did not get through its motions");
  }
  return estimate(context, arguments, {report.log});
}

int write_motions(const Context& context, const CalibrateArguments& arguments) {
  std::string error;
  const auto text = motions_of(robot_named(arguments), &error);
  if (!text) return fail(context, kFailed, kCommand, error);
  if (const int failed = save_text(context, arguments.write_motions, *text)) return failed;
  std::cout << "written: " << arguments.write_motions << "\n";
  return kDone;
}

int run(const Context& context, const CalibrateArguments& arguments) {
  if (!arguments.logs.empty()) return estimate(context, arguments, arguments.logs);
  if (!arguments.write_motions.empty()) return write_motions(context, arguments);
  if (arguments.simulate) return simulate(context, arguments);
  if (!arguments.settings.empty() || !arguments.simulated_log.empty() || arguments.trust ||
      !arguments.robot.empty()) {
    return fail(context, kUsage, kCommand,
                "--set, --log, --robot and --trust are for --simulate; the robot is that of gaitd");
  }
  std::vector<std::string> logs;
  if (const int failed = play_live(context, arguments.motions, &logs)) return failed;
  return estimate(context, arguments, logs, true);
}

}  // namespace

void add_calibrate_command(CLI::App* app, Context* context) {
  auto* command = app->add_subcommand(
      "calibrate", "Measure zeros, stiffnesses and foot sensors of a robot by its own motions");
  command->footer(
      "The robot hangs on its hoist, disarmed, feet clear of the ground. It moves the joints of "
      "its\n"
      "legs one by one, is armed and lowered, and takes some postures on both feet. What its\n"
      "encoders, IMU and force sensors say in them must fit together: that gives the calibration,\n"
      "with standard deviations, and tells what cannot be known without a jig. Exit code 0: the\n"
      "file is written; 1: refused or failed; 4: the log is damaged.");
  auto arguments = std::make_shared<CalibrateArguments>();
  command
      ->add_option("LOG", arguments->logs,
                   "Nothing moves: a log of such motions is looked at (.mcap), and those in which "
                   "it goes on")
      ->type_name("FILE");
  command->add_flag("--simulate", arguments->simulate,
                    "With a simulated robot on a private gaitd, in lockstep");
  add_settings(command, context, &arguments->settings,
               "With --simulate: any key of the configuration or the scenario; may be repeated");
  command
      ->add_option("--log", arguments->simulated_log,
                   "With --simulate: log file; by default a new file in $XDG_STATE_HOME/gaitd/logs "
                   "(~/.local/state/gaitd/logs). The output of gaitd goes beside it as FILE.txt")
      ->type_name("FILE");
  command->add_flag("--trust", arguments->trust,
                    "With --simulate: load libraries that the scenario or its robot.yaml names by "
                    "path");
  const auto* motions =
      command
          ->add_option(
              "--motions", arguments->motions,
              "Scenario whose commands are the motions; by default made for the robot, from "
              "its legs, their ranges and its size")
          ->type_name("NAME|FILE");
  context->values[motions] = [](const auto&) { return daemon::Paths::detect().scenarios(); };
  const auto* robot =
      command
          ->add_option("--robot", arguments->robot,
                       "With --simulate or --write-motions: a name, or the path of a robot.yaml")
          ->type_name("NAME|FILE");
  context->values[robot] = [](const auto&) { return daemon::Paths::detect().robots(); };
  command
      ->add_option(
          "--write-motions", arguments->write_motions,
          "Write the motions made for a robot as a scenario, for --motions, and do nothing "
          "else")
      ->type_name("FILE")
      ->excludes("--simulate");
  command
      ->add_option("-o,--output", arguments->output,
                   "Where to write; by default calibration/measured.yaml beside robot.yaml")
      ->type_name("FILE");
  command
      ->add_option("--zero-sigma", arguments->prior.zero,
                   "How wrong the zeros of the encoders may be before, rad, one standard deviation")
      ->check(CLI::Range(1e-4, 0.2))
      ->capture_default_str();
  command
      ->add_option("--imu-sigma", arguments->prior.accelerometer,
                   "Likewise bias and mounting of the accelerometer, m/s^2")
      ->check(CLI::Range(1e-4, 5.0))
      ->capture_default_str();
  command->callback([context, arguments] {
    context->action = [context, arguments] { return run(*context, *arguments); };
  });
}

}  // namespace gaitd::cli
