// SPDX-License-Identifier: Apache-2.0
#include "ros2/robot_messages.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cli/live/robot_metadata.h"

namespace gaitd::ros2 {
namespace {

using nlohmann::json;

constexpr std::array kAxes = {"x", "y", "z"};
constexpr std::array kAngles = {"roll", "pitch", "yaw"};

Eigen::Quaterniond rotation(const Eigen::Vector3d& rpy) {
  return Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX());
}

Eigen::Vector3d pick(std::span<const double> values, const std::array<int, 3>& signals) {
  return {values[signals[0]], values[signals[1]], values[signals[2]]};
}

geometry_msgs_msg_dds__Vector3_ vector(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

geometry_msgs_msg_dds__Quaternion_ quaternion(const Eigen::Quaterniond& q) {
  return {q.x(), q.y(), q.z(), q.w()};
}

template <class Sequence, class Value>
void point_to(std::vector<Value>& values, Sequence* sequence) {
  sequence->_buffer = values.data();
  sequence->_length = sequence->_maximum = static_cast<std::uint32_t>(values.size());
  sequence->_release = false;
}

// Three numbers, or zeros where there are none.
Eigen::Vector3d three(const json& values) {
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; values.is_array() && i < 3 && i < values.size(); ++i) {
    if (values[i].is_number()) result[static_cast<int>(i)] = values[i].get<double>();
  }
  return result;
}

}  // namespace

const std::vector<std::string>& RobotMessages::signals() {
  static const std::vector<std::string> kSignals = {
      "pelvis/*",        "foot/*/roll",      "foot/*/pitch",     "foot/*/yaw",    "foot/*/force/?",
      "foot/*/moment/?", "joint/*/position", "joint/*/velocity", "joint/*/torque"};
  return kSignals;
}

void RobotMessages::Transforms::add(const std::string& parent, const std::string& child,
                                    const Eigen::Isometry3d& X) {
  names.push_back({parent, child});
  geometry_msgs_msg_dds__TransformStamped_ one{};
  one.transform.translation = vector(X.translation());
  one.transform.rotation = quaternion(Eigen::Quaterniond(X.linear()));
  list.push_back(one);
}

void RobotMessages::Transforms::finish() {
  for (std::size_t i = 0; i < list.size(); ++i) {
    list[i].header.frame_id = names[i][0].data();
    list[i].child_frame_id = names[i][1].data();
  }
  point_to(list, &message.transforms);
}

std::unique_ptr<RobotMessages> RobotMessages::create(const json& robot,
                                                     const daemon::SignalTable& table,
                                                     std::string* error) {
  auto motion = daemon::RobotMotion::create(cli::log_metadata_of(robot), table);
  if (!motion) {
    *error = "gaitd describes no robot whose URDF and signals fit: is it of another version?";
    return nullptr;
  }
  std::unique_ptr<RobotMessages> messages(new RobotMessages(std::move(motion)));
  if (!messages->find_signals(table, error) || !messages->add_soles(robot, error)) return nullptr;
  return messages;
}

RobotMessages::RobotMessages(std::unique_ptr<daemon::RobotMotion> motion)
    : motion_(std::move(motion)) {
  const GaitdModel& model = motion_->model();
  pelvis_name_ = model.bodies[0].name;
  for (int i = 0; i < model.joint_count; ++i) joint_names_.emplace_back(model.joints[i].name);
  for (std::string& name : joint_names_) joint_name_pointers_.push_back(name.data());
  positions_.resize(joint_names_.size());
  velocities_.resize(joint_names_.size());
  efforts_.resize(joint_names_.size());
  joint_state_.header.frame_id = no_frame_.data();
  point_to(joint_name_pointers_, &joint_state_.name);
  point_to(positions_, &joint_state_.position);
  point_to(velocities_, &joint_state_.velocity);
  point_to(efforts_, &joint_state_.effort);
  for (int body = 0; body < model.body_count; ++body) {
    const int parent = model.bodies[body].parent;
    transforms_.add(parent < 0 ? odometry_frame_ : model.bodies[parent].name,
                    model.bodies[body].name, Eigen::Isometry3d::Identity());
  }
  transforms_.finish();
  odometry_.header.frame_id = odometry_frame_.data();
  odometry_.child_frame_id = pelvis_name_.data();
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    sole_names_[side] = std::string(kSides[side]) + "_sole";
    wrenches_[side].header.frame_id = sole_names_[side].data();
  }
  add_fixed_links();
}

bool RobotMessages::find_signals(const daemon::SignalTable& table, std::string* error) {
  const auto find = [&](const std::string& prefix, const std::array<const char*, 3>& ends,
                        std::array<int, 3>* signals) {
    for (std::size_t i = 0; i < ends.size(); ++i) {
      (*signals)[i] = find_signal(table, prefix + ends[i]);
      if ((*signals)[i] < 0) *error = "gaitd has no signal " + prefix + ends[i];
    }
  };
  find("pelvis/velocity/", kAxes, &velocity_);
  find("pelvis/angular_velocity/", kAxes, &angular_velocity_);
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    const std::string foot = "foot/" + std::string(kSides[side]) + "/";
    find(foot, kAngles, &feet_[side].rpy);
    find(foot + "force/", kAxes, &feet_[side].force);
    find(foot + "moment/", kAxes, &feet_[side].moment);
  }
  width_ = table.size();
  for (std::size_t i = 0; i < width_; ++i) {
    const std::string& name = table[i].name;
    if (name.starts_with("pelvis/") || name.ends_with("/position")) {
      needed_.push_back(i);
    }
  }
  return error->empty();
}

void RobotMessages::add_fixed_links() {
  const GaitdModel& model = motion_->model();
  for (const dynamics::UrdfLink& link : motion_->links()) {
    const std::string body = model.bodies[link.body].name;
    if (link.name == body) continue;
    Eigen::Isometry3d X(link.R_BL);
    X.translation() = link.p_BL;
    fixed_.add(body, link.name, X);
  }
}

bool RobotMessages::add_soles(const json& robot, std::string* error) {
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    const json::json_pointer foot("/robot/feet/" + std::string(kSides[side]));
    const json link = robot.contains(foot / "link") ? robot.at(foot / "link") : json();
    if (!link.is_string()) {
      *error = "gaitd does not say which link the " + std::string(kSides[side]) + " foot is";
      return false;
    }
    const json sole = robot.at(foot).value("sole", json::object());
    Eigen::Isometry3d X(rotation(three(sole.value("rpy", json()))));
    X.translation() = three(sole.value("xyz", json()));
    fixed_.add(link.get<std::string>(), sole_names_[side], X);
  }
  fixed_.finish();
  return true;
}

bool RobotMessages::read(std::span<const double> values, Stamp stamp) {
  if (values.size() != width_) return false;
  if (!std::ranges::all_of(needed_, [&](std::size_t i) { return std::isfinite(values[i]); })) {
    return false;
  }
  motion_->read(values);
  for (std::size_t i = 0; i < joint_names_.size(); ++i) {
    positions_[i] = motion_->position()[static_cast<Eigen::Index>(i)];
    velocities_[i] = motion_->velocity()[static_cast<Eigen::Index>(i)];
    efforts_[i] = motion_->torque()[static_cast<Eigen::Index>(i)];
  }
  for (std::size_t body = 0; body < transforms_.list.size(); ++body) {
    const Eigen::Isometry3d X = motion_->X_parent(static_cast<int>(body));
    transforms_.list[body].transform = {vector(X.translation()),
                                        quaternion(Eigen::Quaterniond(X.linear()))};
  }
  const Eigen::Isometry3d X_WP = motion_->X_WP();
  const Eigen::Vector3d& p = X_WP.translation();
  const Eigen::Quaterniond R_WP(X_WP.linear());
  odometry_.pose.pose = {{p.x(), p.y(), p.z()}, quaternion(R_WP)};
  const Eigen::Vector3d w = pick(values, angular_velocity_);
  const Eigen::Vector3d v = pick(values, velocity_) + w.cross(p - motion_->p_W0());
  odometry_.twist.twist.linear = vector(R_WP.conjugate() * v);
  odometry_.twist.twist.angular = vector(R_WP.conjugate() * w);
  for (std::size_t side = 0; side < feet_.size(); ++side) {
    const Eigen::Quaterniond R_SW = rotation(pick(values, feet_[side].rpy)).conjugate();
    wrenches_[side].wrench.force = vector(R_SW * pick(values, feet_[side].force));
    wrenches_[side].wrench.torque = vector(R_SW * pick(values, feet_[side].moment));
  }
  set_stamp(stamp);
  return true;
}

void RobotMessages::set_stamp(Stamp stamp) {
  joint_state_.header.stamp = odometry_.header.stamp = stamp;
  for (auto& transform : transforms_.list) transform.header.stamp = stamp;
  for (auto& wrench : wrenches_) wrench.header.stamp = stamp;
}

const tf2_msgs_msg_dds__TFMessage_& RobotMessages::fixed_transforms(Stamp stamp) {
  for (auto& transform : fixed_.list) transform.header.stamp = stamp;
  return fixed_.message;
}

}  // namespace gaitd::ros2
