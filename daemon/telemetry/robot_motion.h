// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "daemon/log/signal.h"
#include "gaitd/dynamics/kinematics.h"
#include "gaitd/dynamics/urdf.h"

namespace gaitd::daemon {

// Where the bodies of the robot are by the signals of a tick, for those who show it: the frames are
// those of the links of the URDF, also where robot.yaml gives the pelvis another frame or turns
// joints around.
class RobotMotion {
 public:
  // `metadata` of a log, which holds the URDF. Null where there is no robot in it, or the table
  // lacks the pose of the pelvis or a joint.
  static std::unique_ptr<RobotMotion> create(const std::map<std::string, std::string>& metadata,
                                             const SignalTable& table);
  // The robot without signals: place() tells where it is, read() cannot. Null where there is none
  // in `metadata`.
  static std::unique_ptr<RobotMotion> load(const std::map<std::string, std::string>& metadata);

  const GaitdModel& model() const { return model_; }
  const std::string& urdf() const { return urdf_; }
  // Links of the file, and where they are in the links of the bodies that carry them.
  const std::vector<dynamics::UrdfLink>& links() const { return links_; }

  // One tick, values in table order.
  void read(std::span<const double> values);
  // As the signals have it: the pelvis as x, y, z, roll, pitch, yaw (m, rad), every joint in the
  // order of the model.
  void place(std::span<const double, 6> pelvis, std::span<const double> joints);

  // ---- Of the tick that was read last.
  // Pose of the link of the pelvis in the world.
  Eigen::Isometry3d X_WP() const { return X_WL(0); }
  // m, origin of body 0 in the world, whose velocity is in the signals.
  Eigen::Vector3d p_W0() const { return kinematics_.p_WB(0); }
  // Pose of the link of a body in that of its parent, of the pelvis in the world.
  Eigen::Isometry3d X_parent(int body) const;
  // Pose of one of links() in the world.
  Eigen::Isometry3d X_link(const dynamics::UrdfLink& link) const;
  const Eigen::VectorXd& position() const { return position_; }  // rad or m, by joint
  const Eigen::VectorXd& velocity() const { return velocity_; }  // rad/s or m/s
  const Eigen::VectorXd& torque() const { return torque_; }      // N m or N, measured

 private:
  RobotMotion(const dynamics::UrdfResult& robot, std::string urdf);
  // Pose of the link that a body is called after.
  Eigen::Isometry3d X_WL(int body) const;
  bool find_signals(const SignalTable& table);
  void update(std::span<const double, 6> pelvis);

  struct JointSignals {
    int position = -1, velocity = -1, torque = -1;
  };
  GaitdModel model_;
  std::vector<Eigen::Isometry3d> X_BL_;  // by body, of the link that it is called after
  std::vector<dynamics::UrdfLink> links_;
  std::string urdf_;
  dynamics::Kinematics kinematics_;
  Eigen::VectorXd position_, velocity_, torque_;
  std::array<int, 6> pelvis_{};  // x y z roll pitch yaw
  std::vector<JointSignals> joints_;
};

}  // namespace gaitd::daemon
