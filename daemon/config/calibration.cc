// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/calibration.h"

#include <vector>

#include "daemon/config/command_parse.h"
#include "daemon/config/joint_names.h"
#include "daemon/config/yaml_reader.h"

namespace gaitd::daemon {
namespace {

constexpr Bounds kZero = {-0.2, 0.2, "rad"};
constexpr Bounds kStiffness = {500.0, 1e7, "N m/rad"};
constexpr Bounds kTorque = {-1e3, 1e3, "N m"};
constexpr Bounds kFriction = {0.0, 1e3, "N m"};
constexpr Bounds kViscous = {0.0, 1e3, "N m s/rad"};

void read_joints(MapReader map, const GaitdModel& model, Calibration* calibration) {
  std::vector<std::string> names;
  for (int i = 0; i < model.joint_count; ++i) names.emplace_back(model.joints[i].name);
  for (const Node::Entry& entry : map.entries()) {
    const std::string path = map.path_of(entry.key);
    MapReader figures(entry.value, path, map.issues());
    const auto zero = figures.number("zero", kZero);
    const auto stiffness = figures.number("stiffness", kStiffness);
    const auto bias = figures.number("torque_bias", kTorque);
    const auto coulomb = figures.number("coulomb", kFriction);
    const auto viscous = figures.number("viscous", kViscous);
    figures.finish();
    for (const int joint : joints_like(entry, path, names, map.issues())) {
      JointCalibration& to = calibration->joints[joint];
      to.zero = zero.value_or(to.zero);
      to.stiffness = stiffness.value_or(to.stiffness);
      to.torque_bias = bias.value_or(to.torque_bias);
      to.coulomb = coulomb.value_or(to.coulomb);
      to.viscous = viscous.value_or(to.viscous);
    }
  }
}

void read_foot(MapReader map, FootCalibration* foot) {
  foot->mass = map.number("mass", {0.0, 50.0, "kg"}).value_or(0.0);
  map.numbers("com", foot->com, {-1.0, 1.0, "m"});
  map.numbers("force", foot->force, {-1e3, 1e3, "N"});
  map.numbers("moment", foot->moment, {-100.0, 100.0, "N m"});
  map.finish();
}

// How well the zeros are known: for people and programs, the control does not use it.
void check_covariance(MapReader map, const GaitdModel& model) {
  if (!map.valid() || map.entries().empty()) return map.finish();
  map.require({"joints", "zeros"});
  const std::vector<NodePtr> names = map.list("joints", 1, GAITD_MAX_JOINTS);
  for (const NodePtr& name : names) {
    const std::string text = name->kind == NodeKind::kScalar ? name->text : "";
    if (joint_index(model, text) < 0)
      map.fail("joints", "joints of the robot", describe(*name), "");
  }
  const std::vector<NodePtr> rows = map.list("zeros", 0, GAITD_MAX_JOINTS);
  bool square = rows.size() == names.size();
  for (const NodePtr& row : rows) {
    square = square && row->kind == NodeKind::kList && row->items.size() == names.size();
    for (const NodePtr& item : row->items) square = square && as_number(*item).has_value();
  }
  if (!square) map.fail("zeros", "rows of numbers, one row and one number for each joint", "", "");
  map.finish();
}

}  // namespace

std::optional<Calibration> read_calibration(const NodePtr& document, const GaitdModel& model,
                                            Issues* issues) {
  Issues found;
  Calibration calibration;
  MapReader root(document, "", &found);
  root.require({"schema", "robot"});
  root.schema("gaitd.calibration/1");
  const auto robot = root.text("robot");
  if (robot && *robot != model.name) {
    root.fail("robot", model.name, *robot, "give the calibration of the robot that is used");
  }
  read_joints(root.map("joints"), model, &calibration);
  MapReader feet = root.map("feet");
  read_foot(feet.map("left"), &calibration.feet[GAITD_LEFT]);
  read_foot(feet.map("right"), &calibration.feet[GAITD_RIGHT]);
  feet.finish();
  check_covariance(root.map("covariance"), model);
  root.finish();
  issues->append(found);
  if (!found.ok()) return std::nullopt;
  return calibration;
}

}  // namespace gaitd::daemon
