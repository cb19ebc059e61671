// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/robot_motion.h"

#include <utility>

namespace gaitd::daemon {

RobotMotion::RobotMotion(const dynamics::UrdfResult& robot, std::string urdf)
    : model_(robot.model),
      links_(robot.links),
      urdf_(std::move(urdf)),
      kinematics_(model_),
      position_(Eigen::VectorXd::Zero(model_.joint_count)),
      velocity_(position_),
      torque_(position_) {}

std::unique_ptr<RobotMotion> RobotMotion::create(const std::map<std::string, std::string>& metadata,
                                                 const SignalTable& table) {
  const auto urdf = metadata.find("robot_urdf");
  if (urdf == metadata.end()) return nullptr;
  dynamics::UrdfOptions options;
  if (const auto pelvis = metadata.find("pelvis"); pelvis != metadata.end()) {
    options.root_link = pelvis->second;
  }
  const dynamics::UrdfResult robot = dynamics::load_urdf_text(urdf->second, "the log", options);
  if (!robot.ok()) return nullptr;
  std::unique_ptr<RobotMotion> motion(new RobotMotion(robot, urdf->second));
  return motion->find_signals(table) ? std::move(motion) : nullptr;
}

bool RobotMotion::find_signals(const SignalTable& table) {
  constexpr std::array kPose = {"x", "y", "z", "roll", "pitch", "yaw"};
  for (std::size_t i = 0; i < kPose.size(); ++i) {
    pelvis_[i] = find_signal(table, std::string("pelvis/") + kPose[i]);
    if (pelvis_[i] < 0) return false;
  }
  for (int i = 0; i < model_.joint_count; ++i) {
    const std::string joint = "joint/" + std::string(model_.joints[i].name);
    joints_.push_back({find_signal(table, joint + "/position"),
                       find_signal(table, joint + "/velocity"),
                       find_signal(table, joint + "/torque")});
    if (joints_.back().position < 0 || joints_.back().velocity < 0 || joints_.back().torque < 0) {
      return false;
    }
  }
  return true;
}

void RobotMotion::read(std::span<const double> values) {
  for (int i = 0; i < model_.joint_count; ++i) {
    position_[i] = values[joints_[i].position];
    velocity_[i] = values[joints_[i].velocity];
    torque_[i] = values[joints_[i].torque];
  }
  const Eigen::Quaterniond R_WP = Eigen::AngleAxisd(values[pelvis_[5]], Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(values[pelvis_[4]], Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(values[pelvis_[3]], Eigen::Vector3d::UnitX());
  // Only poses are asked for, so no velocity is needed.
  kinematics_.update({values[pelvis_[0]], values[pelvis_[1]], values[pelvis_[2]]}, R_WP,
                     dynamics::Vector6d::Zero(), position_, velocity_);
}

Eigen::Isometry3d RobotMotion::X_parent(int body) const {
  const int parent = model_.bodies[body].parent;
  const Eigen::Isometry3d X = kinematics_.X_WB(body);
  return parent < 0 ? X : kinematics_.X_WB(parent).inverse() * X;
}

}  // namespace gaitd::daemon
