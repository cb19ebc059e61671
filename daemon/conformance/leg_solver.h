// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "gaitd/dynamics/kinematics.h"

namespace gaitd::daemon {

// Joint positions that put the soles where they should be: damped least squares from the posture of
// the tick before, for legs of any six or more joints.
class LegSolver {
 public:
  explicit LegSolver(const GaitdModel& model) : model_(model), kinematics_(model) {}

  // Moves the leg joints in `q` (rad) so that the sole of `side` comes to `sole` (W) with the
  // pelvis level at `pelvis` (m, W), within the joint limits and as near as the leg reaches.
  void solve(int side, const Eigen::Vector3d& pelvis, const Eigen::Vector3d& sole,
             Eigen::VectorXd& q);

 private:
  const GaitdModel& model_;
  dynamics::Kinematics kinematics_;
};

}  // namespace gaitd::daemon
