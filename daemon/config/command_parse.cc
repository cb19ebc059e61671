// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/command_parse.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <span>

#include "daemon/config/leg_kinematics.h"
#include "daemon/config/names.h"
#include "daemon/config/pose_parse.h"
#include "daemon/config/yaml_reader.h"

namespace gaitd::daemon {
namespace {

constexpr std::array<std::string_view, 2> kLengthUnits = {"m", "legs"};
constexpr int kMaxSteps = 1000;
constexpr std::int64_t kMaxSession = std::int64_t{1} << 53;  // whole as a double
constexpr Bounds kDuration = {0.05, 20.0, "s"};
constexpr Bounds kSolePosition = {-1.0, 1.0, "m"};
constexpr double kLeastLoad = 0.001;    // kg
constexpr double kUsualFriction = 0.5;  // of a hand on a surface

template <class Meaning>
struct Method {
  std::string_view name;
  Meaning means;
};
// nullptr: it is none of these.
template <class Meaning, std::size_t kSize>
const Meaning* find_method(const std::array<Method<Meaning>, kSize>& methods,
                           std::string_view name) {
  const auto found = std::find_if(methods.begin(), methods.end(),
                                  [&](const Method<Meaning>& m) { return m.name == name; });
  return found == methods.end() ? nullptr : &found->means;
}

constexpr std::array<Method<CommandType>, 10> kPlainMethods = {{
    {"arm", CommandType::kArm},
    {"disarm", CommandType::kDisarm},
    {"estop", CommandType::kEstop},
    {"reset", CommandType::kReset},
    {"pause", CommandType::kPause},
    {"resume", CommandType::kResume},
    {"stop", CommandType::kStop},
    {"abort", CommandType::kAbort},
    {"tare", CommandType::kTare},
    {"sim.reset", CommandType::kSimReset},
}};

constexpr std::array<Method<PayloadAction>, 3> kPayloadMethods = {{
    {"payload.set", PayloadAction::kSet},
    {"payload.clear", PayloadAction::kClear},
    {"payload.estimate", PayloadAction::kEstimate},
}};

NodePtr map_of(std::string_view key, const NodePtr& value) {
  auto map = std::make_shared<Node>();
  map->kind = NodeKind::kMap;
  map->where = value->where;
  map->entries.push_back({std::string(key), value->where, value});
  return map;
}

// The short forms of scenario files (`pause: true`, `mode: walk-bent`, `footsteps: [...]`) as maps.
NodePtr expanded(std::string_view method, const NodePtr& params, bool plain,
                 const std::string& path, Issues* issues) {
  if (!params || params->kind == NodeKind::kNull) {
    auto empty = std::make_shared<Node>();
    empty->kind = NodeKind::kMap;
    if (params) empty->where = params->where;
    return empty;
  }
  if (plain && params->kind == NodeKind::kScalar) {
    if (as_boolean(*params) != true) {
      issues->add(params->where, path, "true", describe(*params),
                  "write true or leave the command out");
    }
    return expanded(method, nullptr, plain, path, issues);
  }
  if (method == "mode" && params->kind == NodeKind::kScalar) return map_of("mode", params);
  if (params->kind == NodeKind::kList && (method == "footsteps" || method == "replace")) {
    return map_of("footsteps", params);
  }
  return params;
}

void read_walk(MapReader* map, const GaitdModel* model, walking::WalkCommand* walk) {
  map->require({"steps"});
  walk->steps = static_cast<int>(map->integer("steps", 1, kMaxSteps).value_or(0));
  walk->length = map->number("length", {-2.0, 2.0, "m"}).value_or(0.0);
  walk->lateral = map->number("lateral", {-1.0, 1.0, "m"}).value_or(0.0);
  walk->width = map->number("width", {0.0, 2.0, "m"}).value_or(0.0);
  walk->turn = map->number("turn", {-1.6, 1.6, "rad"}).value_or(0.0);
  walk->swing_duration = map->number("swing", kDuration).value_or(0.0);
  walk->transfer_duration = map->number("transfer", kDuration).value_or(0.0);
  walk->first_side = map->choice("first", kSideNames).value_or(GAITD_BOTH);
  const bool in_legs = map->choice("unit", kLengthUnits).value_or(0) == 1;
  const double unit = in_legs && model ? leg_length(*model) : 1.0;
  walk->length *= unit;
  walk->lateral *= unit;
  walk->width *= unit;
}

// A scenario's velocity holds until its next command; a client's has to be renewed.
void read_drive(MapReader* map, bool holds, walking::VelocityCommand* drive) {
  drive->velocity.forward = map->number("forward", {-3.0, 3.0, "m/s"}).value_or(0.0);
  drive->velocity.lateral = map->number("lateral", {-3.0, 3.0, "m/s"}).value_or(0.0);
  drive->velocity.turn = map->number("turn", {-3.0, 3.0, "rad/s"}).value_or(0.0);
  drive->holds = holds;
  if (holds) return;
  drive->session = map->integer("session", 0, kMaxSession).value_or(0);
  drive->renewal = map->boolean("renew").value_or(false);
  drive->ends = map->boolean("end").value_or(false);
  const walking::Velocity& v = drive->velocity;
  if (drive->ends && (drive->renewal || v.forward != 0.0 || v.lateral != 0.0 || v.turn != 0.0)) {
    map->fail("end", "no velocity and no renew beside it", "one of them", "");
  }
}

void read_goto(MapReader* map, GotoTarget* target) {
  map->require({"x", "y"});
  target->x = map->number("x", kPositionBounds).value_or(0.0);
  target->y = map->number("y", kPositionBounds).value_or(0.0);
  const auto yaw = map->number("yaw", {-100.0, 100.0, "rad"});
  target->has_yaw = yaw.has_value();
  target->yaw = yaw.value_or(0.0);
}

void read_contact_polygon(MapReader* map, GaitdFootstep* footstep) {
  const std::vector<NodePtr> nodes = map->list("contact_polygon", 3, GAITD_MAX_FOOT_POINTS);
  const std::string path = map->path_of("contact_polygon");
  const std::vector<double> points = read_points(nodes, path, 2, kSolePosition, map->issues());
  if (points.empty()) return;
  footstep->polygon_count = static_cast<int>(points.size() / 2);
  std::copy(points.begin(), points.end(), &footstep->contact_polygon[0][0]);
  std::string why;
  if (!is_convex_counter_clockwise(points, 2, &why)) {
    map->fail("contact_polygon", "a convex outline, counter-clockwise from above", why, "");
  }
}

// The height of a region is where the foothold is: only its outline is used.
void check_region_height(MapReader* map, const std::vector<double>& points, double foothold) {
  constexpr double kTolerance = 0.05;  // m
  double low = points[2], high = points[2];
  for (std::size_t i = 2; i < points.size(); i += 3) {
    low = std::min(low, points[i]);
    high = std::max(high, points[i]);
  }
  if (foothold >= low - kTolerance && foothold <= high + kTolerance) return;
  const auto metres = [](double value) {
    char text[32];
    std::snprintf(text, sizeof(text), "%g m", value);
    return std::string(text);
  };
  map->fail("landing_region", "a region at the height of the foothold, " + metres(foothold),
            "one from " + metres(low) + " to " + metres(high), "correct z of the one or the other");
}

void read_landing_region(MapReader* map, GaitdFootstep* footstep) {
  const std::vector<NodePtr> nodes = map->list("landing_region", 3, GAITD_MAX_REGION_POINTS);
  const std::string path = map->path_of("landing_region");
  const std::vector<double> points = read_points(nodes, path, 3, kPositionBounds, map->issues());
  if (points.empty()) return;
  footstep->region_count = static_cast<int>(points.size() / 3);
  footstep->region_told = 1;
  std::copy(points.begin(), points.end(), &footstep->landing_region[0][0]);
  std::string why;
  if (!is_convex_counter_clockwise(points, 3, &why)) {
    map->fail("landing_region", "a convex outline, counter-clockwise from above", why, "");
  } else if (const double* p = footstep->pose.position; !is_inside(points, 3, p[0], p[1])) {
    map->fail("landing_region", "a region around the foothold itself", "one beside it",
              "it may be shifted inside the region only: move the region or the footstep");
  } else {
    check_region_height(map, points, p[2]);
  }
}

void read_footstep(MapReader map, GaitdFootstep* footstep) {
  map.require({"side", "x", "y"});
  footstep->side = map.choice("side", kSideNames).value_or(GAITD_LEFT);
  footstep->pose.position[0] = map.number("x", kPositionBounds).value_or(0.0);
  footstep->pose.position[1] = map.number("y", kPositionBounds).value_or(0.0);
  footstep->pose.position[2] = map.number("z", kPositionBounds).value_or(0.0);
  const double yaw = map.number("yaw", {-100.0, 100.0, "rad"}).value_or(0.0);
  const double pitch = map.number("pitch", {-1.0, 1.0, "rad"}).value_or(0.0);
  const double roll = map.number("roll", {-1.0, 1.0, "rad"}).value_or(0.0);
  const Eigen::Quaterniond orientation = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                                         Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                                         Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
  Eigen::Map<Eigen::Vector4d>(footstep->pose.orientation) = orientation.coeffs();
  footstep->swing_duration = map.number("swing", kDuration).value_or(0.0);
  footstep->transfer_duration = map.number("transfer", kDuration).value_or(0.0);
  footstep->swing_height = map.number("swing_height", {0.01, 1.0, "m"}).value_or(0.0);
  read_contact_polygon(&map, footstep);
  read_landing_region(&map, footstep);
  map.finish();
}

void read_footsteps(MapReader* map, bool replace, Command* command) {
  map->require({"footsteps"});
  const std::vector<NodePtr> nodes = map->list("footsteps", 1, walking::kMaxFootstepsPerCommand);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::string path = map->path_of("footsteps") + "[" + std::to_string(i) + "]";
    read_footstep(MapReader(nodes[i], path, map->issues()), &command->footsteps[i]);
  }
  command->footstep_count = static_cast<int>(nodes.size());
  command->replace = map->boolean("replace").value_or(replace) || replace;
}

// -1: there is none.
int read_link(MapReader* map, const GaitdModel* model) {
  const auto link = map->text("link");
  if (!link || model == nullptr) return -1;
  const int body = body_index(*model, *link);
  if (body < 0) {
    map->fail("link", "a link of the robot that moves", *link,
              suggestion(*link, body_names(*model)));
  }
  return body;
}

// A load of the simulation may be taken off by a mass of 0.
void read_load(MapReader* map, const GaitdModel* model, double least, GaitdLoad* load) {
  map->require({"link", "mass"});
  load->body = read_link(map, model);
  load->mass = map->number("mass", {least, 1000.0, "kg"}).value_or(least);
  map->numbers("com", load->com, {-10.0, 10.0, "m"});
}

void read_payload(MapReader* map, const GaitdModel* model, PayloadAction action,
                  PayloadCommand* payload) {
  payload->action = action;
  if (action == PayloadAction::kSet) return read_load(map, model, kLeastLoad, &payload->load);
  payload->load.body = read_link(map, model);
  const bool needs_link = action == PayloadAction::kEstimate;
  if (needs_link && model != nullptr && !map->has("link")) payload->load.body = model->chest_body;
}

void read_handhold(MapReader* map, bool release, walking::HandholdCommand* handhold) {
  handhold->release = release;
  handhold->hand = map->choice("hand", kSideNames).value_or(GAITD_BOTH);
  if (release) return;
  map->require({"hand", "normal", "force"});
  const bool told = map->numbers("normal", handhold->normal, {-1.0, 1.0, ""});
  constexpr double kShortest = 0.1;
  if (told && Eigen::Map<Eigen::Vector3d>(handhold->normal).norm() < kShortest) {
    map->fail("normal", "a direction: from the surface towards the robot", "nearly none", "");
  }
  handhold->friction = map->number("friction", {0.05, 2.0, ""}).value_or(kUsualFriction);
  handhold->force = map->number("force", {1.0, 1e5, "N"}).value_or(0.0);
}

void read_push(MapReader* map, const GaitdModel* model, GaitdDisturbance* push) {
  map->require({"link", "force", "duration"});
  push->body = read_link(map, model);
  map->numbers("force", push->force, {-1e5, 1e5, "N"});
  map->numbers("point", push->point, {-10.0, 10.0, "m"});
  push->duration = map->number("duration", {1e-4, 60.0, "s"}).value_or(0.0);
}

void read_joint_test(MapReader* map, const GaitdModel* model, JointTest* test) {
  map->require({"joint"});
  const auto name = map->text("joint");
  if (name && model) {
    test->joint = joint_index(*model, *name);
    if (test->joint < 0) {
      std::vector<std::string> names(model->joint_count);
      for (int i = 0; i < model->joint_count; ++i) names[i] = model->joints[i].name;
      map->fail("joint", "a joint of the robot", *name, suggestion(*name, names));
    }
  }
  test->amplitude = map->number("amplitude", {-0.3, 0.3, "rad"}).value_or(test->amplitude);
  test->duration = map->number("duration", {0.5, 20.0, "s"}).value_or(test->duration);
}

}  // namespace

const std::vector<std::string>& command_methods() {
  static const std::vector<std::string> kMethods = [] {
    std::vector<std::string> names = {
        "mode", "walk",     "drive",    "velocity",   "goto",          "footsteps",       "replace",
        "pose", "sim.push", "sim.load", "joint.test", "handhold.take", "handhold.release"};
    for (const auto& payload : kPayloadMethods) names.emplace_back(payload.name);
    for (const auto& plain : kPlainMethods) names.emplace_back(plain.name);
    std::sort(names.begin(), names.end());
    return names;
  }();
  return kMethods;
}

std::optional<Command> parse_command(std::string_view method, const NodePtr& params,
                                     const GaitdModel* model, const std::string& path,
                                     Issues* issues) {
  const CommandType* plain = find_method(kPlainMethods, method);
  const PayloadAction* payload = find_method(kPayloadMethods, method);
  Issues found;
  MapReader map(expanded(method, params, plain != nullptr, path, &found), path, &found);
  Command command{};
  if (plain != nullptr) {
    command.type = *plain;
  } else if (method == "mode") {
    command.type = CommandType::kMode;
    map.require({"mode"});
    command.mode = map.choice("mode", kModeNames).value_or(GAITD_MODE_STAND);
  } else if (method == "walk") {
    command.type = CommandType::kWalk;
    read_walk(&map, model, &command.walk);
  } else if (method == "drive" || method == "velocity") {
    command.type = CommandType::kDrive;
    read_drive(&map, method == "velocity", &command.drive);
  } else if (method == "goto") {
    command.type = CommandType::kGoto;
    read_goto(&map, &command.target);
  } else if (method == "footsteps" || method == "replace") {
    command.type = CommandType::kFootsteps;
    read_footsteps(&map, method == "replace", &command);
  } else if (method == "sim.push") {
    command.type = CommandType::kPush;
    read_push(&map, model, &command.push);
  } else if (method == "sim.load") {
    command.type = CommandType::kSimLoad;
    read_load(&map, model, 0.0, &command.load);
  } else if (payload != nullptr) {
    command.type = CommandType::kPayload;
    read_payload(&map, model, *payload, &command.payload);
  } else if (method == "handhold.take" || method == "handhold.release") {
    command.type = CommandType::kHandhold;
    read_handhold(&map, method == "handhold.release", &command.handhold);
  } else if (method == "pose") {
    command.type = CommandType::kPose;
    read_pose(&map, model, &command.pose);
  } else if (method == "joint.test") {
    command.type = CommandType::kJointTest;
    read_joint_test(&map, model, &command.joint_test);
  } else {
    found.add_text(
        map.where(), path,
        "unknown command '" + std::string(method) + "'; " + suggestion(method, command_methods()));
    issues->append(found);
    return std::nullopt;
  }
  map.finish();
  issues->append(found);
  if (!found.ok()) return std::nullopt;
  return command;
}

std::optional<Command> parse_command(std::string_view method, const nlohmann::json& params,
                                     const GaitdModel& model, std::string* error) {
  Issues issues;
  auto command = parse_command(method, from_json(params, {}), &model, std::string(method), &issues);
  *error = issues.error_text();
  return command;
}

int mode_from_name(std::string_view name) {
  const auto found = std::find(kModeNames.begin(), kModeNames.end(), name);
  return found == kModeNames.end() ? -1 : static_cast<int>(found - kModeNames.begin());
}

std::string_view mode_name(int mode) {
  return mode >= 0 && mode < static_cast<int>(kModeNames.size()) ? kModeNames[mode] : "unknown";
}

int body_index(const GaitdModel& model, std::string_view name) {
  for (int i = 0; i < model.body_count; ++i) {
    if (name == model.bodies[i].name) return i;
  }
  return -1;
}

std::vector<std::string> body_names(const GaitdModel& model) {
  std::vector<std::string> names(model.body_count);
  for (int i = 0; i < model.body_count; ++i) names[i] = model.bodies[i].name;
  return names;
}

int joint_index(const GaitdModel& model, std::string_view name) {
  for (int i = 0; i < model.joint_count; ++i) {
    if (name == model.joints[i].name) return i;
  }
  return -1;
}

}  // namespace gaitd::daemon
