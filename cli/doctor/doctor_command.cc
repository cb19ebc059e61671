// SPDX-License-Identifier: Apache-2.0
#include "cli/doctor/doctor_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>

#include "cli/doctor/log_doctor.h"
#include "cli/doctor/machine_doctor.h"
#include "cli/doctor/robot_doctor.h"
#include "cli/failure.h"
#include "cli/log_damage.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "daemon/config/paths.h"
#include "daemon/log/log_reader.h"

namespace gaitd::cli {
namespace {

constexpr char kMcapMagic[] = "\x89MCAP";

bool is_log(const std::string& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return file.ends_with(".mcap");
  std::ifstream in(file, std::ios::binary);
  char begin[5] = {};
  in.read(begin, sizeof(begin));
  return file.ends_with(".mcap") || std::equal(begin, begin + sizeof(begin), kMcapMagic);
}

int show(const Context& context, const std::string& what, const std::string& subject,
         const doctor::Findings& findings) {
  const bool problem = doctor::any_problem(findings);
  if (context.json) {
    std::cout << json_text(
        {{what, subject}, {"problem", problem}, {"findings", doctor::findings_json(findings)}});
  } else {
    std::cout << subject << "\n" << doctor::findings_text(findings);
  }
  return problem ? kFailed : kDone;
}

int of_log(const Context& context, const std::string& file) {
  std::string error;
  const auto log = daemon::LogReader::open(file, &error);
  if (!log) return fail(context, kFailed, "doctor", error);
  if (log->tick_count() == 0) {
    return fail(context, kFailed, "doctor", file + ": holds no tick, nothing to look at");
  }
  std::optional<Waiting> waiting("reading " + file);
  const doctor::LogDiagnosis diagnosis = doctor::diagnose_log(*log);
  waiting.reset();
  if (context.json) {
    nlohmann::json result = doctor::diagnosis_json(file, diagnosis);
    add_damage(*log, &result);
    std::cout << json_text(result);
  } else {
    std::cout << doctor::diagnosis_text(file, diagnosis);
  }
  return tell_damage("doctor", *log, diagnosis.ending.empty() ? kDone : kFailed);
}

int of_robot(const Context& context, const std::string& name) {
  const daemon::Paths paths = daemon::Paths::detect();
  std::error_code ignored;
  const bool folder = std::filesystem::is_directory(name, ignored);
  const auto file = paths.robot(folder ? name + "/robot.yaml" : name);
  if (!file) {
    std::string there;
    for (const std::string& robot : paths.robots()) there += " " + robot;
    return fail(context, kFailed, "doctor",
                name + ": expected a log (.mcap), a robot.yaml or one of the robots" + there +
                    "; without FILE the machine is looked at");
  }
  return show(context, "robot", file->string(), doctor::diagnose_robot(file->string()));
}

int run(const Context& context, const std::string& file) {
  if (file.empty()) {
    std::optional<Waiting> waiting("looking at this machine");
    const doctor::Findings findings = doctor::diagnose_machine();
    waiting.reset();
    return show(context, "machine", "this machine", findings);
  }
  return is_log(file) ? of_log(context, file) : of_robot(context, file);
}

}  // namespace

void add_doctor_command(CLI::App* app, Context* context) {
  auto* command = app->add_subcommand(
      "doctor", "What is wrong with this machine, with a robot, or with the walk in a log");
  command->footer(
      "Without FILE: kernel, limits, governor, wake-ups and CAN interfaces of this machine. With "
      "a\n"
      "robot.yaml or the name of a robot: masses, inertias, frames, reach, torques and the "
      "standing\n"
      "ICP. With a log: what went wrong first before a fall or fault, when, and which parameter "
      "to\n"
      "look at. Exit code 0: nothing that keeps it from working, no fall and no fault; 1: there "
      "is;\n"
      "warnings alone do not count; 4: the log is damaged.");
  auto file = std::make_shared<std::string>();
  command->add_option("FILE", *file, "A log (.mcap), a robot.yaml or the name of a robot")
      ->type_name("FILE");
  command->callback(
      [context, file] { context->action = [context, file] { return run(*context, *file); }; });
}

}  // namespace gaitd::cli
