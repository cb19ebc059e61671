// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/scene_topics.h"

#include <google/protobuf/descriptor.pb.h>

#include <Eigen/Geometry>
#include <utility>

#include "daemon/telemetry/robot_motion.h"
#include "daemon/telemetry/scene_drawing.h"
#include "foxglove.pb.h"

namespace gaitd::daemon {
namespace {

constexpr std::uint64_t kPeriod = 33'000'000;  // ns

using google::protobuf::FileDescriptor;
using google::protobuf::FileDescriptorSet;

// The file of the messages after those that it imports.
std::string schema_text() {
  FileDescriptorSet set;
  const FileDescriptor* file = foxglove::SceneUpdate::descriptor()->file();
  for (int i = 0; i < file->dependency_count(); ++i) file->dependency(i)->CopyTo(set.add_file());
  file->CopyTo(set.add_file());
  return set.SerializeAsString();
}

void set_time(std::uint64_t time_ns, google::protobuf::Timestamp* stamp) {
  stamp->set_seconds(static_cast<std::int64_t>(time_ns / 1'000'000'000));
  stamp->set_nanos(static_cast<std::int32_t>(time_ns % 1'000'000'000));
}

}  // namespace

struct SceneTopics::Impl {
  Impl(std::unique_ptr<RobotMotion> robot, SceneDrawing scene)
      : motion(std::move(robot)), drawing(std::move(scene)) {}

  void write_transforms(std::uint64_t time_ns, MessageSink* sink);
  void write_joints(std::uint64_t time_ns, MessageSink* sink);
  template <class Message>
  void write_message(std::uint16_t channel, std::uint64_t time_ns, const Message& message,
                     MessageSink* sink) {
    message.AppendToString(&sink->begin_message(channel, time_ns));
    sink->end_message();
  }

  std::unique_ptr<RobotMotion> motion;
  SceneDrawing drawing;
  std::uint16_t transforms_channel = 0, joints_channel = 0, scene_channel = 0, robot_channel = 0;
  bool begun = false;
  std::uint64_t next = 0;
};

void SceneTopics::Impl::write_transforms(std::uint64_t time_ns, MessageSink* sink) {
  const GaitdModel& model = motion->model();
  foxglove::FrameTransforms message;
  const auto add = [&](const std::string& parent, const std::string& child,
                       const Eigen::Isometry3d& X) {
    foxglove::FrameTransform* transform = message.add_transforms();
    set_time(time_ns, transform->mutable_timestamp());
    transform->set_parent_frame_id(parent);
    transform->set_child_frame_id(child);
    transform->mutable_translation()->set_x(X.translation().x());
    transform->mutable_translation()->set_y(X.translation().y());
    transform->mutable_translation()->set_z(X.translation().z());
    const Eigen::Quaterniond R(X.linear());
    transform->mutable_rotation()->set_x(R.x());
    transform->mutable_rotation()->set_y(R.y());
    transform->mutable_rotation()->set_z(R.z());
    transform->mutable_rotation()->set_w(R.w());
  };
  for (int body = 0; body < model.body_count; ++body) {
    const int parent = model.bodies[body].parent;
    add(parent < 0 ? kWorldFrame : model.bodies[parent].name, model.bodies[body].name,
        motion->X_parent(body));
  }
  // Who reads the URDF alone takes joints that gaitd fixes to be at zero.
  for (const dynamics::UrdfLink& link : motion->links()) {
    const char* body = model.bodies[link.body].name;
    if (link.name == body) continue;
    Eigen::Isometry3d X(link.R_BL);
    X.translation() = link.p_BL;
    add(body, link.name, X);
  }
  write_message(transforms_channel, time_ns, message, sink);
}

void SceneTopics::Impl::write_joints(std::uint64_t time_ns, MessageSink* sink) {
  const GaitdModel& model = motion->model();
  foxglove::JointStates message;
  set_time(time_ns, message.mutable_timestamp());
  foxglove::JointState* state = message.add_joints();
  set_time(time_ns, state->mutable_timestamp());
  for (int i = 0; i < model.joint_count; ++i) {
    state->add_name(model.joints[i].name);
    state->add_position(motion->position()[i]);
    state->add_velocity(motion->velocity()[i]);
    state->add_effort(motion->torque()[i]);
  }
  write_message(joints_channel, time_ns, message, sink);
}

SceneTopics::SceneTopics() = default;
SceneTopics::~SceneTopics() = default;

std::unique_ptr<SceneTopics> SceneTopics::create(const std::map<std::string, std::string>& metadata,
                                                 const SignalTable& table) {
  std::unique_ptr<RobotMotion> motion = RobotMotion::create(metadata, table);
  if (!motion) return nullptr;
  std::unique_ptr<SceneTopics> topics(new SceneTopics);
  topics->impl_ = std::make_unique<Impl>(std::move(motion), SceneDrawing(metadata, table));
  return topics;
}

void SceneTopics::add_channels(MessageSink* sink) {
  const std::string text = schema_text();
  const auto add = [&](const char* topic, const char* name) {
    return sink->add_channel(sink->add_schema(name, "protobuf", text), topic, "protobuf", {});
  };
  impl_->transforms_channel = add(kTransformsTopic, "foxglove.FrameTransforms");
  impl_->joints_channel = add(kJointsTopic, "foxglove.JointStates");
  impl_->scene_channel = add(kSceneTopic, "foxglove.SceneUpdate");
  impl_->robot_channel = add(kRobotTopic, "foxglove.RobotDescription");
  impl_->begun = false;
}

void SceneTopics::begin_again() { impl_->begun = false; }

bool SceneTopics::begun() const { return impl_->begun; }

void SceneTopics::write(std::uint64_t time_ns, std::span<const double> values, MessageSink* sink) {
  Impl& impl = *impl_;
  // A reset simulation begins again at zero.
  if (impl.begun && time_ns < impl.next && impl.next - time_ns <= kPeriod) return;
  impl.next = time_ns + kPeriod;
  foxglove::SceneUpdate scene;
  if (!impl.begun) {
    foxglove::RobotDescription description;
    description.set_data(impl.motion->urdf());
    description.set_format("urdf");
    impl.write_message(impl.robot_channel, time_ns, description, sink);
    impl.drawing.add_terrain(&scene);
    impl.begun = true;
  }
  impl.motion->read(values);
  impl.write_transforms(time_ns, sink);
  impl.write_joints(time_ns, sink);
  impl.drawing.add_gait(values, &scene);
  for (foxglove::SceneEntity& entity : *scene.mutable_entities()) {
    set_time(time_ns, entity.mutable_timestamp());
    entity.set_frame_id(kWorldFrame);
  }
  impl.write_message(impl.scene_channel, time_ns, scene, sink);
}

}  // namespace gaitd::daemon
