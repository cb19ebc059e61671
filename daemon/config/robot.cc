// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/robot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "daemon/config/leg_kinematics.h"
#include "daemon/config/paths.h"
#include "daemon/config/robot_geometry.h"
#include "daemon/config/yaml_reader.h"
#include "gaitd/dynamics/model_check.h"
#include "gaitd/dynamics/urdf.h"

namespace gaitd::daemon {
namespace {

constexpr std::size_t kMostFixed = 256;

void read_parameters(MapReader map, SettingSource source, Settings* settings, Issues* issues) {
  for (const Node::Entry& entry : map.entries()) {
    const std::string path = map.path_of(entry.key);
    if (entry.key.find('.') == std::string::npos) {
      issues->add(entry.where, path, "scope.name or layer/variant.name", entry.key,
                  "write for example gait.swing_duration");
    } else if (entry.value->kind != NodeKind::kScalar) {
      issues->add(entry.value->where, path, "a value", describe(*entry.value), "write one value");
    } else if (settings) {
      settings->set(source, entry.key, entry.value);
    }
  }
}

void read_impedance_state(MapReader map, RobotGeometry* geometry, JointImpedance* impedance) {
  for (const Node::Entry& entry : map.entries()) {
    MapReader gains(entry.value, map.path_of(entry.key), map.issues());
    const double stiffness = gains.number("stiffness", {0.0, 1e5, "N m/rad"}).value_or(0.0);
    const double damping = gains.number("damping", {0.0, 1e4, "N m s/rad"}).value_or(0.0);
    gains.finish();
    for (const int joint : geometry->joints_like(entry, map.path_of(entry.key))) {
      impedance->stiffness[joint] = stiffness;
      impedance->damping[joint] = damping;
    }
  }
}

void read_profile(MapReader map, RobotGeometry* geometry, Settings* settings,
                  ImpedanceProfile* impedance) {
  read_parameters(map.map("parameters"), SettingSource::kProfile, settings, map.issues());
  impedance->given = map.has("impedance");
  MapReader states = map.map("impedance");
  read_impedance_state(states.map("support"), geometry, &impedance->support);
  read_impedance_state(states.map("swing"), geometry, &impedance->swing);
  read_impedance_state(states.map("heel_strike"), geometry, &impedance->heel_strike);
  states.finish();
  map.finish();
}

// Of the profile that is not chosen only the form is checked.
void read_profiles(MapReader profiles, Profile chosen, RobotGeometry* geometry, Settings* settings,
                   Robot* robot) {
  ImpedanceProfile unused;
  const bool hardware = chosen == Profile::kHardware;
  read_profile(profiles.map("simulation"), geometry, hardware ? nullptr : settings,
               hardware ? &unused : &robot->impedance);
  read_profile(profiles.map("hardware"), geometry, hardware ? settings : nullptr,
               hardware ? &robot->impedance : &unused);
  profiles.finish();
}

std::string format(const char* pattern, double a, double b, double c) {
  char buffer[160];
  std::snprintf(buffer, sizeof(buffer), pattern, a, b, c);
  return buffer;
}

// Both soles level, at one height, beside each other, and the centre of mass above them. Of these
// the first that is wrong: a tilted sole stands elsewhere too.
void check_posture(const GaitdModel& model, const PostureFigures& figures, const Location& where,
                   Issues* issues) {
  constexpr double kAngle = 2e-3;     // rad
  constexpr double kDistance = 2e-3;  // m
  const auto& left = figures.sole_position[GAITD_LEFT];
  const auto& right = figures.sole_position[GAITD_RIGHT];
  const std::string_view path = "posture";
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    if (figures.sole_tilt[side] > kAngle || std::abs(figures.sole_yaw[side]) > kAngle) {
      issues->add(
          where, path, "level soles that point forward (within 0.002 rad)",
          format(side == GAITD_LEFT ? "the left one tilted by %.4f rad, turned by %.4f rad"
                                    : "the right one tilted by %.4f rad, turned by %.4f rad",
                 figures.sole_tilt[side], figures.sole_yaw[side], 0.0),
          "correct the ankles: their pitch undoes hip and knee, their roll the hip roll");
      return;
    }
  }
  if (std::abs(left[0] - right[0]) > kDistance || std::abs(left[2] - right[2]) > kDistance ||
      left[1] <= right[1]) {
    issues->add(where, path, "soles side by side (within 2 mm), the left one at the left",
                format("left - right = (%.4f, %.4f, %.4f) m", left[0] - right[0],
                       left[1] - right[1], left[2] - right[2]),
                "give both legs the same angles, mirrored");
    return;
  }
  double front = -1e9;
  double back = 1e9;
  for (int i = 0; i < model.feet[GAITD_LEFT].point_count; ++i) {
    front = std::max(front, left[0] + model.feet[GAITD_LEFT].points[i][0]);
    back = std::min(back, left[0] + model.feet[GAITD_LEFT].points[i][0]);
  }
  const auto& com = figures.com;
  if (com[0] > front || com[0] < back || com[1] > left[1] || com[1] < right[1]) {
    issues->add(
        where, path, "a centre of mass above the feet",
        format("%.4f m in front of the middle of the soles, %.4f m beside it",
               com[0] - 0.5 * (left[0] + right[0]), com[1] - 0.5 * (left[1] + right[1]), 0.0),
        "lean the legs: move hip pitch and take the same from ankle pitch");
  }
}

void finish_model(const Location& posture, GaitdModel* model, Issues* issues) {
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const std::string expected = compute_bend_signs(*model, &model->legs[side]);
    if (expected.empty()) continue;
    issues->add(posture, side == GAITD_LEFT ? "legs.left" : "legs.right", expected,
                "joints that do not work as a leg",
                "check hip_pitch, knee and ankle_pitch and the URDF");
    return;
  }
  const PostureFigures figures = compute_posture_figures(*model);
  check_posture(*model, figures, posture, issues);
  model->nominal_pelvis_height = figures.pelvis_height();
  model->nominal_com_height = figures.com_height();
  model->nominal_foot_separation = figures.foot_separation();
}

// The link, or a map of it and of the axes that x forward, y left and z up are in it.
void read_pelvis(MapReader* root, dynamics::UrdfOptions* options) {
  const NodePtr node = root->node("pelvis");
  if (!node) return;
  if (node->kind != NodeKind::kMap) {
    options->root_link = root->text("pelvis").value_or("");
    return;
  }
  MapReader map = root->map("pelvis");
  map.require({"link"});
  options->root_link = map.text("link").value_or("");
  std::array<double, 3> rpy{};
  map.numbers("rpy", rpy, kAngle);
  options->R_LB = from_rpy(rpy);
  map.numbers("xyz", std::span(options->p_LB.data(), 3), {-10.0, 10.0, "m"});
  map.finish();
}

std::vector<NodePtr> read_fixed(MapReader* root, dynamics::UrdfOptions* options) {
  std::vector<NodePtr> nodes;
  if (!root->has("fixed")) return nodes;
  for (const NodePtr& node : root->list("fixed", 0, kMostFixed)) {
    if (node->kind != NodeKind::kScalar || node->text.empty()) {
      root->fail("fixed", "names or globs of joints", describe(*node), "write [\"*_finger_*\"]");
      continue;
    }
    options->fixed.push_back(node->text);
    nodes.push_back(node);
  }
  return nodes;
}

dynamics::UrdfResult load_urdf_of(MapReader* root, const std::string& file, const UrdfLoader& load,
                                  Robot* robot, Issues* issues) {
  const auto urdf = root->text("urdf");
  dynamics::UrdfOptions& options = robot->urdf_options;
  options.limits_required = false;  // drive_limits has what the file lacks
  options.nearest_inertias = root->boolean("nearest_inertias").value_or(false);
  read_pelvis(root, &options);
  const std::vector<NodePtr> fixed = read_fixed(root, &options);
  dynamics::UrdfResult result;
  if (!urdf) {
    result.errors.push_back("no file");  // the missing key is reported already
    return result;
  }
  robot->urdf = (std::filesystem::path(file).parent_path() / *urdf).lexically_normal().string();
  result = load(robot->urdf, options);
  for (const std::string& error : result.errors) {
    issues->add_text(root->where("urdf"), "urdf", error);
  }
  for (const std::string& warning : result.warnings) {
    issues->warn(root->where("urdf"), "urdf", warning);
  }
  for (const NodePtr& node : fixed) {
    const auto& unused = result.unused_fixed;
    if (std::find(unused.begin(), unused.end(), node->text) == unused.end()) continue;
    issues->add(node->where, "fixed", "a joint of the URDF or a glob (*_finger_*)", node->text,
                "correct or remove it");
  }
  return result;
}

}  // namespace

std::optional<Robot> load_robot(const std::string& file, Profile profile, Settings* settings,
                                Issues* issues) {
  Issues found;
  const NodePtr document = load_yaml_file(file, &found);
  std::optional<Robot> robot;
  if (document) robot = read_robot(document, file, profile, dynamics::load_urdf, settings, &found);
  issues->append(found);
  return found.ok() ? robot : std::nullopt;
}

void load_calibration(const std::string& name, Robot* robot, const Location& where,
                      Issues* issues) {
  if (name.empty()) return;
  const auto folder = std::filesystem::path(robot->file).parent_path() / "calibration";
  robot->calibration_file = is_path(name) ? name : (folder / (name + ".yaml")).string();
  std::error_code error;
  if (!std::filesystem::is_regular_file(robot->calibration_file, error)) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
      if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
    }
    std::sort(names.begin(), names.end());
    issues->add(where, "calibration", "a calibration of this robot, or the path of one", name,
                suggestion(name, names));
    return;
  }
  Issues found;
  const NodePtr document = load_yaml_file(robot->calibration_file, &found);
  if (document) {
    const auto calibration = read_calibration(document, robot->model, &found);
    if (calibration) robot->calibration = *calibration;
  }
  issues->append(found);
}

NodePtr load_wiring(const NodePtr& value, const std::string& folder, Issues* issues) {
  if (!value || value->kind != NodeKind::kScalar) return value;
  return load_yaml_file((std::filesystem::path(folder) / value->text).lexically_normal().string(),
                        issues);
}

std::optional<Robot> read_robot(const NodePtr& document, const std::string& file, Profile profile,
                                const UrdfLoader& load, Settings* settings, Issues* issues) {
  Issues found;
  MapReader root(document, "", &found);
  Robot robot;
  robot.file = file;
  root.require({"schema", "name", "urdf", "pelvis", "feet", "legs", "imus", "posture"});
  root.schema("gaitd.robot/1");
  robot.name = root.text("name").value_or("");
  if (robot.name.size() >= GAITD_NAME_SIZE) {
    root.fail("name", "at most 47 characters", std::to_string(robot.name.size()), "shorten it");
  }

  const dynamics::UrdfResult urdf = load_urdf_of(&root, file, load, &robot, &found);
  robot.model = urdf.model;
  std::strncpy(robot.model.name, robot.name.c_str(), GAITD_NAME_SIZE - 1);
  robot.model.name[GAITD_NAME_SIZE - 1] = '\0';

  RobotGeometry geometry(&urdf, &robot.model, &found);
  geometry.read_chest(&root);
  geometry.read_imus(&root);
  geometry.read_feet(&root);
  geometry.read_hands(&root);
  geometry.read_capsules(&root);
  geometry.read_legs(&root);
  geometry.read_drive_limits(root.map("drive_limits"));
  geometry.read_posture(&root);
  std::array<double, GAITD_MAX_JOINTS> rotor_inertia{};
  geometry.read_joint_values(root.map("rotor_inertia"), {0.0, 100.0, "kg m^2"},
                             rotor_inertia.data());
  for (int i = 0; i < robot.model.joint_count; ++i) {
    robot.model.joints[i].rotor_inertia = rotor_inertia[i];
  }
  read_parameters(root.map("parameters"), SettingSource::kRobot, settings, &found);
  read_profiles(root.map("profiles"), profile, &geometry, settings, &robot);
  robot.can = root.node("can");
  root.finish();

  // Figures only mean something when everything that goes into them is right.
  if (found.ok()) {
    for (const std::string& error : dynamics::check_model(robot.model)) {
      found.add_text(root.where("urdf"), "urdf", error);
    }
  }
  if (found.ok()) finish_model(root.where("posture"), &robot.model, &found);
  issues->append(found);
  if (!found.ok()) return std::nullopt;
  return robot;
}

}  // namespace gaitd::daemon
