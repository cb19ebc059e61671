// SPDX-License-Identifier: Apache-2.0
#include "cli/pose_command.h"

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/ask.h"
#include "cli/completion_values.h"
#include "cli/failure.h"
#include "daemon/config/issues.h"
#include "daemon/config/node.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;

struct PoseArguments {
  std::string part;
  json where = json::object();   // what `pose` gets under the name of the part
  std::shared_ptr<json> params;  // the rest
  std::string points;            // a file
  std::vector<std::string> joints;
};

// The way of --points: a list, checked by gaitd, which knows the robot.
std::optional<json> read_way(const std::string& file, std::string* error) {
  daemon::Issues issues;
  const daemon::NodePtr root = file == "-" ? daemon::read_yaml(std::cin, "standard input", &issues)
                                           : daemon::load_yaml_file(file, &issues);
  if (root != nullptr && issues.ok() && root->kind != daemon::NodeKind::kList) {
    issues.add(root->where, "", "a list of points {time, ...}", daemon::describe(*root),
               "see `gaitctl pose --help`");
  }
  if (root == nullptr || !issues.ok()) {
    *error = "\n" + issues.error_text();
    return std::nullopt;
  }
  return daemon::to_json(*root);
}

// NAME=RAD, each joint once.
bool read_joint(const std::string& text, json* joints) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) return false;
  if (joints->contains(text.substr(0, equals))) return false;
  const char* number = text.c_str() + equals + 1;
  char* end = nullptr;
  const double value = std::strtod(number, &end);
  if (end == number || *end != '\0') return false;
  (*joints)[text.substr(0, equals)] = value;
  return true;
}

int send(const Context& context, const PoseArguments& arguments) {
  const std::string command = "pose " + arguments.part;
  json params = *arguments.params;
  json& where = params[arguments.part];
  if (where.is_null()) where = json::object();
  where.update(arguments.where);
  for (const std::string& joint : arguments.joints) {
    if (!read_joint(joint, &where["joints"])) {
      return fail(context, kUsage, command,
                  "--joint " + joint + ": NAME=RAD expected, each joint once");
    }
  }
  if (!arguments.points.empty()) {
    std::string error;
    const auto way = read_way(arguments.points, &error);
    if (!way) return fail(context, kFailed, command, error);
    where["points"] = *way;
  }
  return ask(context, command, "pose", params);
}

std::shared_ptr<PoseArguments> add_part(CLI::App* pose, Context* context, const std::string& part,
                                        const std::string& description, CLI::App** command) {
  auto arguments = std::make_shared<PoseArguments>();
  arguments->part = part;
  arguments->params = std::make_shared<json>(json::object());
  *command = pose->add_subcommand(part, description);
  add_number(*command, "--duration", arguments->params, "/duration", "Of the way there, s");
  (*command)
      ->add_option(
          "--points", arguments->points,
          "YAML file with a way of up to 16 points in place of one, or - for standard input")
      ->type_name("FILE");
  (*command)->callback([context, arguments] {
    context->action = [context, arguments] { return send(*context, *arguments); };
  });
  return arguments;
}

void add_side(CLI::App* command, const std::shared_ptr<PoseArguments>& arguments) {
  command
      ->add_option_function<std::string>(
          "SIDE", [arguments](const std::string& side) { arguments->where["side"] = side; },
          "left or right")
      ->required()
      ->check(CLI::IsMember({"left", "right"}));
}

void add_axes(CLI::App* command, const std::shared_ptr<PoseArguments>& arguments,
              const std::vector<std::pair<std::string, std::string>>& axes) {
  for (const auto& [name, description] : axes) {
    add_number(command, "--" + name, arguments->params, "/" + arguments->part + "/" + name,
               description);
  }
}

}  // namespace

void add_pose_command(CLI::App* app, Context* context) {
  auto* pose =
      app->add_subcommand("pose", "Move pelvis, chest, arms and hands, standing or walking");
  pose->require_subcommand(1);
  pose->footer(
      "Ways are minimum-jerk; a file of --points is a list, its keys are those of the options:\n"
      "  - {time: 1.0, x: 0.4, y: 0.3, z: 0.1}\n"
      "  - {time: 2.5, x: 0.5, y: 0.2, z: 0.1}\n"
      "of an arm: - {time: 1.0, joints: {l_arm_elx: 1.2}}");
  CLI::App* command = nullptr;
  auto part = add_part(
      pose, context, "pelvis",
      "Centre of mass and pelvis against where they are by themselves; nothing: back", &command);
  add_axes(command, part,
           {{"x", "Centre of mass forwards, m; only while standing"},
            {"y", "Centre of mass to the left, m; only while standing"},
            {"z", "Its height, m, 0 or below; not with straight legs"},
            {"roll", "Of the pelvis, rad"},
            {"pitch", "Likewise"},
            {"yaw", "Likewise, to the left"}});
  part = add_part(pose, context, "chest",
                  "Turn the chest against where it is by itself; nothing: back", &command);
  add_axes(
      command, part,
      {{"roll", "Of the chest, rad"}, {"pitch", "Likewise"}, {"yaw", "Likewise, to the left"}});
  part = add_part(pose, context, "arm", "Move joints of an arm; nothing: back", &command);
  add_side(command, part);
  const auto* joint = command
                          ->add_option("--joint", part->joints,
                                       "Joint of this arm and its position, rad; several times")
                          ->type_name("NAME=RAD");
  context->values[joint] = [](const auto&) { return joint_names(); };
  part = add_part(pose, context, "hand", "Bring a hand somewhere; what is out of reach is told",
                  &command);
  add_side(command, part);
  command
      ->add_option_function<std::string>(
          "--frame", [part](const std::string& frame) { part->where["frame"] = frame; },
          "world, chest or pelvis, in which the place stays; default chest")
      ->check(CLI::IsMember({"world", "chest", "pelvis"}));
  add_axes(command, part,
           {{"x", "Place of the hand, m; x, y and z or none: the hand only turns"},
            {"y", "Likewise"},
            {"z", "Likewise"},
            {"roll", "Its orientation, rad; none of the three: it stays"},
            {"pitch", "Likewise"},
            {"yaw", "Likewise"}});
}

}  // namespace gaitd::cli
