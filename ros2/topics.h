// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "ros2/dds.h"
#include "ros2/diagnostics.h"
#include "ros2/robot_messages.h"

namespace gaitd::ros2 {

struct TopicOptions {
  std::string name_space;    ///< normalised
  bool best_effort = false;  ///< joint states, odometry and wrenches as sensor data
  bool clock = false;        ///< /clock is published
};

/// All that is published.
class Topics {
 public:
  /// Throws std::runtime_error if DDS refuses.
  Topics(const Participant& participant, const TopicOptions& options);

  /// Robot description and fixed transforms: once, for everybody who will come.
  void publish_robot(RobotMessages* robot, Stamp stamp);
  /// Joints, transforms, odometry and wrenches.
  void publish_tick(const RobotMessages& robot);
  void publish_clock(Stamp stamp);
  void publish_diagnostics(const diagnostic_msgs_msg_dds__DiagnosticArray_& message);

 private:
  Publisher joint_states_, transforms_, fixed_transforms_, odometry_, description_, diagnostics_;
  std::array<Publisher, 2> wrenches_;
  std::optional<Publisher> clock_;
};

}  // namespace gaitd::ros2
