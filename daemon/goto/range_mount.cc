// SPDX-License-Identifier: Apache-2.0
#include "daemon/goto/range_mount.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <string>

#include "daemon/config/command_parse.h"
#include "gaitd/dynamics/kinematics.h"
#include "gaitd/sdk/views.h"

namespace gaitd::daemon {
namespace {

Eigen::Isometry3d pose(const std::array<double, 3>& p, const std::array<double, 3>& rpy) {
  Eigen::Isometry3d X(sdk::from_roll_pitch_yaw(rpy[0], rpy[1], rpy[2]));
  X.translation() = Eigen::Vector3d(p[0], p[1], p[2]);
  return X;
}

// X_BS from where it is in the nominal posture, in the frame of the pelvis.
Eigen::Isometry3d on_chest(const GaitdModel& model, const Eigen::Isometry3d& X_PS) {
  dynamics::Kinematics kinematics(model);
  const Eigen::Map<const Eigen::VectorXd> q(model.nominal_position, model.joint_count);
  kinematics.update(Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity(), sdk::Vector6d::Zero(),
                    q, Eigen::VectorXd::Zero(model.joint_count));
  return kinematics.X_WB(model.chest_body).inverse() * X_PS;
}

}  // namespace

sim::RangeSensorFigures range_sensor(const nlohmann::json& perception, const GaitdModel& model) {
  const std::string sensor = perception.at("sensor");
  auto figures = sim::RangeSensorFigures::of_class(sensor);
  for (const sim::RangeSensorKey& key : sim::kRangeSensorKeys) {
    figures.*key.value = perception.value(key.name, figures.*key.value);
  }
  using Triple = std::array<double, 3>;
  if (perception.contains("link")) {
    figures.body = std::max(0, body_index(model, perception["link"].get<std::string>()));
    figures.X_BS = pose(perception.value("position", Triple{}), perception.value("rpy", Triple{}));
    return figures;
  }
  const double h = model.nominal_pelvis_height;
  const double down = sensor == "depth_camera" ? 0.95 : 0.0;
  figures.body = model.chest_body;
  figures.X_BS = on_chest(model, pose({0.2 * h, 0.0, 0.55 * h}, {0.0, down, 0.0}));
  return figures;
}

}  // namespace gaitd::daemon
