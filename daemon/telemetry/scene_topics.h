// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>

#include "daemon/log/signal.h"
#include "daemon/telemetry/message_sink.h"

namespace gaitd::daemon {

inline constexpr char kTransformsTopic[] = "/tf";            // foxglove.FrameTransforms
inline constexpr char kJointsTopic[] = "/joint_states";      // foxglove.JointStates
inline constexpr char kSceneTopic[] = "/scene";              // foxglove.SceneUpdate
inline constexpr char kRobotTopic[] = "/robot_description";  // foxglove.RobotDescription
inline constexpr char kWorldFrame[] = "world";

// The walk in the standard messages of Foxglove, beside gaitd's own ones and computed from the same
// signals: the frames of all bodies, the joints, and what is drawn around the robot (terrain,
// footsteps, ICP, CoP, CMP). A few times a second of tick time; not for the real-time thread.
class SceneTopics {
 public:
  // `metadata` of a log, which holds URDF, soles and world. Null where there is no robot in it.
  static std::unique_ptr<SceneTopics> create(const std::map<std::string, std::string>& metadata,
                                             const SignalTable& table);
  ~SceneTopics();

  // Schemas and channels, once per file, before any message.
  void add_channels(MessageSink* sink);

  // The next tick is written whatever the time, with what is written once: robot and terrain.
  void begin_again();
  // What is written once has been.
  bool begun() const;

  // One tick, values in table order. Writes only if the last messages are long enough ago.
  void write(std::uint64_t time_ns, std::span<const double> values, MessageSink* sink);

 private:
  SceneTopics();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gaitd::daemon
