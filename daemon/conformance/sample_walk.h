// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "daemon/conformance/input_set.h"
#include "daemon/conformance/leg_solver.h"
#include "gaitd/walking/gait_machine.h"
#include "gaitd/walking/icp_reference.h"
#include "gaitd/walking/objectives.h"
#include "gaitd/walking/swing_trajectory.h"

namespace gaitd::daemon {

// What the layers would read while the robot stands, takes two steps and a closing one on flat
// ground, and stands again: a motion on which sensors, state, gait, plan and objectives agree. The
// centre of mass follows the plan, the feet are where the gait has them, the joints by inverse
// kinematics. No layer and no physics take part, so the same model gives the same numbers always.
class SampleWalk {
 public:
  static constexpr double kPeriod = 0.001;  // s

  explicit SampleWalk(const GaitdModel& model);

  // Makes the next tick; false after the last one.
  bool tick();
  const InputSet& inputs() const { return set_; }

 private:
  void ask_for_motions();
  void move();
  void feel(const Eigen::VectorXd& last_velocity, const Eigen::Vector3d& last_pelvis_velocity);
  void decide();
  Eigen::Vector3d sole(int side);
  double load(int side) const;

  const GaitdModel& model_;
  walking::GaitMachine gait_;
  walking::IcpReference planner_;
  walking::ObjectiveBuilder objectives_;
  walking::SwingTrajectory swing_;
  LegSolver legs_;
  dynamics::Kinematics kinematics_;
  InputSet set_;
  Eigen::VectorXd q_, qd_;
  Eigen::Vector3d pelvis_, pelvis_velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector2d com_ = Eigen::Vector2d::Zero();     // m, W, of the plan
  Eigen::Vector2d offset_ = Eigen::Vector2d::Zero();  // m, pelvis minus CoM
  double standing_height_ = 0.0;                      // m, of the pelvis at the beginning
  int swing_step_ = -1;
  bool walked_ = false;
  double time_standing_ = 0.0;
};

}  // namespace gaitd::daemon
