// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/robot_motion.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

namespace gaitd::daemon {
namespace {

using nlohmann::json;

bool is_number(const json& value) { return value.is_number(); }

}  // namespace

RobotMotion::RobotMotion(const dynamics::UrdfResult& robot, std::string urdf)
    : model_(robot.model),
      X_BL_(static_cast<std::size_t>(model_.body_count), Eigen::Isometry3d::Identity()),
      links_(robot.links),
      urdf_(std::move(urdf)),
      kinematics_(model_),
      position_(Eigen::VectorXd::Zero(model_.joint_count)),
      velocity_(position_),
      torque_(position_) {
  for (const dynamics::UrdfLink& link : links_) {
    if (link.name != model_.bodies[link.body].name) continue;
    X_BL_[static_cast<std::size_t>(link.body)] = Eigen::Translation3d(link.p_BL) * link.R_BL;
  }
  for (dynamics::UrdfLink& link : links_) {
    const Eigen::Isometry3d X_LB = X_BL_[static_cast<std::size_t>(link.body)].inverse();
    link.p_BL = X_LB * link.p_BL;
    link.R_BL = X_LB.linear() * link.R_BL;
  }
}

Eigen::Isometry3d RobotMotion::X_WL(int body) const {
  return kinematics_.X_WB(body) * X_BL_[static_cast<std::size_t>(body)];
}

std::unique_ptr<RobotMotion> RobotMotion::load(const std::map<std::string, std::string>& metadata) {
  const auto urdf = metadata.find("robot_urdf");
  if (urdf == metadata.end()) return nullptr;
  dynamics::UrdfOptions options;
  options.limits_required = false;  // robot.yaml has them
  options.nearest_inertias = true;  // nor does it matter here
  if (const auto pelvis = metadata.find("pelvis"); pelvis != metadata.end()) {
    options.root_link = pelvis->second;
  }
  const auto list = [&](const char* key) {
    const auto text = metadata.find(key);
    return text == metadata.end() ? json() : json::parse(text->second, nullptr, false);
  };
  // Logs from before robot.yaml had them lack these.
  const json axes = list("pelvis_axes");
  if (axes.is_array() && axes.size() == 4 && std::ranges::all_of(axes, is_number)) {
    const Eigen::Quaterniond R_LB(axes[3].get<double>(), axes[0].get<double>(),
                                  axes[1].get<double>(), axes[2].get<double>());
    if (!(R_LB.norm() > 0.5)) return nullptr;
    options.R_LB = R_LB.normalized();
  }
  const json origin = list("pelvis_origin");
  if (origin.is_array() && origin.size() == 3 && std::ranges::all_of(origin, is_number)) {
    options.p_LB = {origin[0].get<double>(), origin[1].get<double>(), origin[2].get<double>()};
  }
  for (const json& joint : list("fixed_joints")) {
    if (joint.is_string()) options.fixed.push_back(joint.get<std::string>());
  }
  const dynamics::UrdfResult robot = dynamics::load_urdf_text(urdf->second, "the log", options);
  if (!robot.ok()) return nullptr;
  return std::unique_ptr<RobotMotion>(new RobotMotion(robot, urdf->second));
}

std::unique_ptr<RobotMotion> RobotMotion::create(const std::map<std::string, std::string>& metadata,
                                                 const SignalTable& table) {
  auto motion = load(metadata);
  return motion != nullptr && motion->find_signals(table) ? std::move(motion) : nullptr;
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
  std::array<double, 6> pelvis;
  std::ranges::transform(pelvis_, pelvis.begin(), [&](int signal) { return values[signal]; });
  update(pelvis);
}

void RobotMotion::place(std::span<const double, 6> pelvis, std::span<const double> joints) {
  for (int i = 0; i < model_.joint_count; ++i) position_[i] = joints[i];
  update(pelvis);
}

void RobotMotion::update(std::span<const double, 6> pelvis) {
  const Eigen::Quaterniond R_WP = Eigen::AngleAxisd(pelvis[5], Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(pelvis[4], Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(pelvis[3], Eigen::Vector3d::UnitX());
  // Only poses are asked for, so no velocity is needed.
  kinematics_.update({pelvis[0], pelvis[1], pelvis[2]}, R_WP, dynamics::Vector6d::Zero(), position_,
                     velocity_);
}

Eigen::Isometry3d RobotMotion::X_parent(int body) const {
  const int parent = model_.bodies[body].parent;
  if (parent < 0) return X_WP();
  return X_WL(parent).inverse() * X_WL(body);
}

Eigen::Isometry3d RobotMotion::X_link(const dynamics::UrdfLink& link) const {
  return X_WL(link.body) * Eigen::Translation3d(link.p_BL) * link.R_BL;
}

}  // namespace gaitd::daemon
