// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "gaitd/dynamics/kinematics.h"
#include "gaitd/sdk/layer.h"
#include "gaitd/walking/joint_chain.h"
#include "gaitd/walking/minimum_jerk_path.h"
#include "gaitd/walking/pose_path.h"

namespace gaitd::plugins {

// Plays the motions that are asked for: minimum-jerk ways through their points, each from where the
// part is on its way when the motion begins. A pose of a hand becomes positions of the joints of
// the arm, tick by tick, inside their limits and with bounded rates; a goal out of reach brings the
// hand as near as it can. Standing, the shift of the CoM is held; a walk takes it back.
class TrajectoryPlayer {
 public:
  static constexpr std::array<GaitdParameter, 0> kParameters = {};

  explicit TrajectoryPlayer(const GaitdModel& model);
  void set_parameter(int, double) {}
  GaitdStatus process(const GaitdTaskSourceInput& in, GaitdTaskReferences& out);
  void reset();
  void get_state(GaitdTaskSourceState& state) const;
  void set_state(const GaitdTaskSourceState& state);

 private:
  using Joints = walking::JointChain::Joints;
  // A part on its way. Of an arm `joints` holds while its motion is one of joints, else `pose`.
  struct Part {
    std::uint32_t id = 0;
    int kind = GAITD_MOTION_NONE;
    double begun = 0.0;    // s of the motion, at which the path begins
    double elapsed = 0.0;  // s, since the path began
    bool resumed = false;  // its state came from another variant: the path is to be made anew
    walking::PosePath pose;
    walking::MinimumJerkPath joints;
    walking::PosePath::Sample pose_now;
    walking::MinimumJerkPath::Sample joints_now;
  };

  void advance(int part, const GaitdMotion& motion, double dt);
  void begin(int part, const GaitdMotion& motion, double elapsed);
  void leave(const GaitdGaitState& gait, double dt);
  void play_body(GaitdTaskReferences& out) const;
  void play_arm(int hand, const GaitdTaskSourceInput& in, GaitdTaskReferences& out);
  void follow_hand(int hand, const GaitdMotion& motion, double dt, GaitdHandReference& out);
  // Pose and twist (W) of what a motion of a hand is relative to.
  Eigen::Isometry3d frame_pose(int frame) const;
  walking::JointChain::Twist frame_twist(int frame, const Eigen::Vector3d& at) const;
  walking::JointChain::Twist twist_at(int body, const Eigen::Vector3d& at) const;
  walking::PosePath::Sample hand_in(int hand, int frame) const;

  const GaitdModel model_;
  dynamics::Kinematics kinematics_;
  std::array<walking::JointChain, GAITD_MAX_HANDS> arms_;
  std::array<Part, GAITD_PART_COUNT> parts_;
  bool leaving_ = false;               // a walk takes the shift of the CoM back
  double left_for_ = 0.0;              // s, since then
  walking::MinimumJerkPath way_back_;  // its axes 0 and 1
  std::array<Joints, GAITD_MAX_HANDS> position_, velocity_, acceleration_;  // references
};

}  // namespace gaitd::plugins
