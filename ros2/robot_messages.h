// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "daemon/log/signal.h"
#include "daemon/telemetry/robot_motion.h"
#include "nav_msgs.h"
#include "ros2/stamp.h"
#include "sensor_msgs.h"
#include "tf2_msgs.h"

namespace gaitd::ros2 {

inline constexpr char kOdometryFrame[] = "odom";  ///< gaitd's world: x forward, z up at the start
inline constexpr std::array kSides = {"left", "right"};

/// What ROS is told of the robot in a tick. The messages stay where they are and belong to this
/// object: DDS reads them while it writes.
class RobotMessages {
 public:
  /// Globs over the signals that are needed.
  static const std::vector<std::string>& signals();

  /// `robot`: answer of robot.describe; `table`: of the frames that will come. Null with the reason
  /// where its robot cannot be understood.
  static std::unique_ptr<RobotMessages> create(const nlohmann::json& robot,
                                               const daemon::SignalTable& table,
                                               std::string* error);

  const std::string& urdf() const { return motion_->urdf(); }

  /// One tick, values in table order. False, and nothing changed, where a pose or the position of a
  /// joint is missing: a robot that is not estimated yet. Else NaN stands for what is not known.
  bool read(std::span<const double> values, Stamp stamp);

  // ---- Of the tick that was read last.
  /// rad, rad/s, N m as measured (m, m/s, N of a prismatic joint).
  const sensor_msgs_msg_dds__JointState_& joint_state() const { return joint_state_; }
  /// Each body in its parent, the pelvis in odom; m.
  const tf2_msgs_msg_dds__TFMessage_& transforms() const { return transforms_.message; }
  /// Pelvis in odom; twist in the axes of the pelvis, m/s and rad/s. Covariances are 0: unknown.
  const nav_msgs_msg_dds__Odometry_& odometry() const { return odometry_; }
  /// Ground on foot, N and N m about the origin of the sole, in its axes (frame left_sole).
  const geometry_msgs_msg_dds__WrenchStamped_& wrench(int side) const { return wrenches_[side]; }

  /// Links on fixed joints in the body that carries them, and the soles in their feet; m.
  const tf2_msgs_msg_dds__TFMessage_& fixed_transforms(Stamp stamp);

 private:
  /// Transforms with the strings that they point to.
  struct Transforms {
    void add(const std::string& parent, const std::string& child, const Eigen::Isometry3d& X);
    void finish();  // all are there
    std::vector<std::array<std::string, 2>> names;
    std::vector<geometry_msgs_msg_dds__TransformStamped_> list;
    tf2_msgs_msg_dds__TFMessage_ message{};
  };
  struct FootSignals {
    std::array<int, 3> rpy, force, moment;
  };

  explicit RobotMessages(std::unique_ptr<daemon::RobotMotion> motion);
  bool find_signals(const daemon::SignalTable& table, std::string* error);
  bool add_soles(const nlohmann::json& robot, std::string* error);
  void add_fixed_links();
  void set_stamp(Stamp stamp);

  std::unique_ptr<daemon::RobotMotion> motion_;
  std::array<int, 3> velocity_{}, angular_velocity_{};
  std::array<FootSignals, 2> feet_{};
  std::size_t width_ = 0;            // signals of a frame
  std::vector<std::size_t> needed_;  // those without which there is no pose

  std::string odometry_frame_ = kOdometryFrame;
  std::string pelvis_name_;
  std::array<std::string, 2> sole_names_;
  std::string no_frame_;
  std::vector<std::string> joint_names_;
  std::vector<char*> joint_name_pointers_;
  std::vector<double> positions_, velocities_, efforts_;
  sensor_msgs_msg_dds__JointState_ joint_state_{};
  Transforms transforms_, fixed_;
  nav_msgs_msg_dds__Odometry_ odometry_{};
  std::array<geometry_msgs_msg_dds__WrenchStamped_, 2> wrenches_{};
};

}  // namespace gaitd::ros2
