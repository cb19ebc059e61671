// SPDX-License-Identifier: Apache-2.0
#include "cli/robot/robot_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/doctor/robot_doctor.h"
#include "cli/failure.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "cli/robot/describe.h"
#include "daemon/config/names.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

struct RobotArguments {
  std::string urdf;
  std::string folder;
  std::string name;
  porting::Told told;
  bool force = false;
};

// A name that files and scenarios may have: what else the file is called by becomes '-'.
std::string name_of(const std::string& urdf) {
  std::string name = fs::path(urdf).stem().string().substr(0, 40);
  std::replace_if(
      name.begin(), name.end(),
      [](unsigned char c) { return std::isalnum(c) == 0 && c != '_' && c != '-'; }, '-');
  return name.empty() ? "robot" : name;
}

// The URDF as robot.yaml in `folder` names it: meshes are found from where it lies, so it stays.
std::string from_folder(const std::string& urdf, const fs::path& folder) {
  std::error_code ignored;
  const fs::path file = fs::weakly_canonical(urdf, ignored);
  const fs::path real = fs::weakly_canonical(folder, ignored);
  // Where a symbolic link leads elsewhere, ".." does not lead back.
  const bool linked = real != (fs::absolute(folder, ignored) / "").lexically_normal().parent_path();
  const fs::path relative = file.lexically_relative(real);
  return linked || relative.empty() ? file.string() : relative.string();
}

std::string write_robot(const fs::path& folder,
                        const std::vector<std::pair<std::string, std::string>>& files) {
  std::error_code error;
  fs::create_directories(folder, error);
  for (const auto& [name, text] : files) {
    std::ofstream out(folder / name, std::ios::binary);
    out << text;
    out.close();
    if (!out) return (folder / name).string() + ": cannot be written";
  }
  return "";
}

int init(const Context& context, const RobotArguments& arguments) {
  const fs::path folder = arguments.folder;
  std::error_code ignored;
  if (!arguments.force && fs::exists(folder / "robot.yaml", ignored)) {
    return fail(context, kFailed, "robot init",
                (folder / "robot.yaml").string() +
                    ": is there already; choose another folder, or --force to write over it");
  }
  std::optional<Waiting> waiting("looking at " + arguments.urdf);
  std::string error;
  const std::string name = arguments.name.empty() ? name_of(arguments.urdf) : arguments.name;
  const auto files = porting::describe_robot(arguments.urdf, from_folder(arguments.urdf, folder),
                                             name, arguments.told, &error);
  waiting.reset();
  if (files.empty()) return fail(context, kFailed, "robot init", error);
  const std::string failed = write_robot(folder, files);
  if (!failed.empty()) return fail(context, kFailed, "robot init", failed);

  const std::string robot = (folder / "robot.yaml").string();
  const doctor::Findings findings = doctor::diagnose_robot(robot);
  if (context.json) {
    nlohmann::json names = nlohmann::json::array();
    for (const auto& [file, text] : files) names.push_back((folder / file).string());
    std::cout << json_text({{"robot", robot},
                            {"files", names},
                            {"problem", doctor::any_problem(findings)},
                            {"findings", doctor::findings_json(findings)}});
  } else {
    std::cout << "made " << folder.string()
              << ": robot.yaml with the reason of every guess, stand.yaml, walk.yaml, "
                 "posture.svg\n"
              << doctor::findings_text(findings) << "now\n  gaitctl run "
              << (folder / "stand.yaml").string() << " " << (folder / "walk.yaml").string() << "\n";
  }
  return doctor::any_problem(findings) ? kFailed : kDone;
}

}  // namespace

void add_robot_command(CLI::App* app, Context* context) {
  auto* robot = app->add_subcommand("robot", "Describe a new robot");
  robot->require_subcommand(1);
  auto* command = robot->add_subcommand(
      "init", "Write robot.yaml, a stand and a walk for the robot of a URDF, guessed and solved");
  command->footer(
      "Finds legs, feet and soles, pelvis, chest and sensors in the URDF and its meshes, solves a\n"
      "standing posture, and scales times and steps with the legs. Every guess stands in\n"
      "robot.yaml with its reason; posture.svg shows it. Then the doctor says what is left. Exit\n"
      "code 1: something keeps the robot from standing. Needs no daemon.");
  auto arguments = std::make_shared<RobotArguments>();
  command->add_option("URDF", arguments->urdf, "Description of the robot")
      ->required()
      ->type_name("FILE");
  command->add_option("-o,--output", arguments->folder, "Folder to make")
      ->required()
      ->type_name("FOLDER");
  command->add_option("--name", arguments->name, "Of the robot; that of the file if left out")
      ->check(CLI::Validator(
          [](const std::string& name) {
            return name.empty() || name.size() >= 48 || !daemon::is_file_name(name)
                       ? "expected 1 to 47 letters, digits and any of . _ -"
                       : std::string();
          },
          ""));
  command->add_option("--fix", arguments->told.fix, "Joints, by name or glob, that do not move")
      ->type_name("GLOB")
      ->expected(1)
      ->take_all();
  command
      ->add_option(
          "--sole", arguments->told.sole,
          "Sole of each foot in m, where its shapes do not show it: the last joint of the leg "
          "is HEIGHT above the ground, the middle of the sole AHEAD of the one that pitches it")
      ->type_name("LENGTH,WIDTH,HEIGHT,AHEAD")
      ->delimiter(',')
      ->expected(4)
      ->check(CLI::Range(-2.0, 2.0));
  command->add_flag("--force", arguments->force, "Write over files that are there");
  command->callback([context, arguments] {
    context->action = [context, arguments] { return init(*context, *arguments); };
  });
}

}  // namespace gaitd::cli
