// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "gaitd/abi/types.h"
#include "gaitd/walking/refusal.h"
#include "gaitd/walking/swing_trajectory.h"

namespace gaitd::walking {

// Where a standing robot is to hold its centre of mass and its pelvis, against where it stands by
// itself. Axes of the heading between the feet.
struct PoseCommand {
  double shift[3] = {};   // m, of the centre of mass
  double turn[3] = {};    // rad, roll, pitch and yaw of the pelvis
  double duration = 1.5;  // s, of the way there
};

// The way to such a pose, continuous in acceleration. It is held while the robot stands; a walk
// begins by leaving it.
class StancePose {
 public:
  explicit StancePose(const GaitdModel& model) : model_(model) {}

  // A refusal changes nothing.
  Refusal command(const PoseCommand& pose, const GaitdGaitState& gait);
  void reset();  // as the robot stands by itself, at once

  // One tick of `dt` seconds.
  void update(double dt, const GaitdGaitState& gait);

  // Moves the reference of the plan by the shift; the ICP by that and its velocity over omega.
  void shift_plan(const GaitdGaitState& gait, GaitdIcpPlan& plan) const;
  double height() const { return value(2); }  // m
  Eigen::Quaterniond turn() const;            // of the pelvis, axes of the heading
  Eigen::Vector3d turn_rate() const;          // rad/s, likewise

 private:
  static constexpr int kAxes = 6;  // x, y, z, roll, pitch, yaw
  void go(const std::array<double, kAxes>& to, double duration);
  double value(int axis) const { return path_[axis].position(time_); }

  const GaitdModel model_;
  std::array<Quintic, kAxes> path_;
  double time_ = 0.0;      // s, on the way
  double duration_ = 0.0;  // s
  bool away_ = false;      // from where it stands by itself, or on the way back
  bool leaving_ = false;   // on the way back, for a walk
};

}  // namespace gaitd::walking
