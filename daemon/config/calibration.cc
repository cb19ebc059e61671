// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/calibration.h"

#include <vector>

#include "daemon/config/joint_names.h"
#include "daemon/config/yaml_reader.h"

namespace gaitd::daemon {
namespace {

constexpr Bounds kZero = {-0.2, 0.2, "rad"};
constexpr Bounds kStiffness = {500.0, 1e7, "N m/rad"};

void read_joints(MapReader map, const GaitdModel& model, Calibration* calibration) {
  std::vector<std::string> names;
  for (int i = 0; i < model.joint_count; ++i) names.emplace_back(model.joints[i].name);
  for (const Node::Entry& entry : map.entries()) {
    const std::string path = map.path_of(entry.key);
    MapReader figures(entry.value, path, map.issues());
    const auto zero = figures.number("zero", kZero);
    const auto stiffness = figures.number("stiffness", kStiffness);
    figures.finish();
    for (const int joint : joints_like(entry, path, names, map.issues())) {
      JointCalibration& to = calibration->joints[joint];
      to.zero = zero.value_or(to.zero);
      to.stiffness = stiffness.value_or(to.stiffness);
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
  root.finish();
  issues->append(found);
  if (!found.ok()) return std::nullopt;
  return calibration;
}

}  // namespace gaitd::daemon
