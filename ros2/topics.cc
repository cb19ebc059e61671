// SPDX-License-Identifier: Apache-2.0
#include "ros2/topics.h"

#include "ros2/names.h"
#include "rosgraph_msgs.h"
#include "std_msgs.h"

namespace gaitd::ros2 {
namespace {

Profile stream_profile(const TopicOptions& options) {
  return options.best_effort ? Profile::kSensorData : Profile::kDefault;
}

Publisher wrench(const Participant& participant, const TopicOptions& options, int side) {
  const std::string topic = "foot/" + std::string(kSides[side]) + "/wrench";
  return {participant, topic_on_wire(options.name_space, topic),
          geometry_msgs_msg_dds__WrenchStamped__desc, stream_profile(options)};
}

}  // namespace

Topics::Topics(const Participant& participant, const TopicOptions& options)
    : joint_states_(participant, topic_on_wire(options.name_space, "joint_states"),
                    sensor_msgs_msg_dds__JointState__desc, stream_profile(options)),
      transforms_(participant, topic_on_wire(options.name_space, "/tf"),
                  tf2_msgs_msg_dds__TFMessage__desc, Profile::kTransforms),
      fixed_transforms_(participant, topic_on_wire(options.name_space, "/tf_static"),
                        tf2_msgs_msg_dds__TFMessage__desc, Profile::kLatched),
      odometry_(participant, topic_on_wire(options.name_space, "odom"),
                nav_msgs_msg_dds__Odometry__desc, stream_profile(options)),
      description_(participant, topic_on_wire(options.name_space, "robot_description"),
                   std_msgs_msg_dds__String__desc, Profile::kLatched),
      diagnostics_(participant, topic_on_wire(options.name_space, "/diagnostics"),
                   diagnostic_msgs_msg_dds__DiagnosticArray__desc, Profile::kDefault),
      wrenches_{wrench(participant, options, 0), wrench(participant, options, 1)} {
  if (options.clock) {
    clock_.emplace(participant, topic_on_wire(options.name_space, "/clock"),
                   rosgraph_msgs_msg_dds__Clock__desc, Profile::kDefault);
  }
}

void Topics::publish_robot(RobotMessages* robot, Stamp stamp) {
  std::string urdf = robot->urdf();
  const std_msgs_msg_dds__String_ description{urdf.data()};
  description_.write(&description);
  fixed_transforms_.write(&robot->fixed_transforms(stamp));
}

void Topics::publish_tick(const RobotMessages& robot) {
  joint_states_.write(&robot.joint_state());
  transforms_.write(&robot.transforms());
  odometry_.write(&robot.odometry());
  for (int side = 0; side < 2; ++side) wrenches_[side].write(&robot.wrench(side));
}

void Topics::publish_clock(Stamp stamp) {
  const rosgraph_msgs_msg_dds__Clock_ message{stamp};
  if (clock_) clock_->write(&message);
}

void Topics::publish_diagnostics(const diagnostic_msgs_msg_dds__DiagnosticArray_& message) {
  diagnostics_.write(&message);
}

}  // namespace gaitd::ros2
