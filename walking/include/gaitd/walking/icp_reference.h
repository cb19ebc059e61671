// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "gaitd/abi/plugin.h"
#include "gaitd/walking/icp_trajectory.h"

namespace gaitd::walking {

// The ICP reference of every tick, continuous whatever happens to the plan (theory section 2).
// The first transfer out of standing is fitted to the reference so far, and so is the last one when
// the plan changes in the swing before it (a pause, a stop); at every other change, and of what a
// fit leaves,
// (early or late touchdown, moved, added or re-timed steps) the difference is kept and decays:
//   xi_ref = xi_plan + delta,  delta' = -k delta,  r_ref = r_plan + (1 + k/w) delta
// What another variant had planned otherwise is also left of delta at touchdown, and expected
// there: nothing has happened to the robot that a foothold had to move for.
class IcpReference {
 public:
  explicit IcpReference(const GaitdModel& model) : model_(model) { reset(); }

  void reset() {
    state_ = {};
    state_.size = sizeof(state_);
    state_.plan_revision = kNotStarted;
    otherwise_.setZero();
  }
  void get_state(GaitdIcpPlannerState& state) const { state = state_; }
  // Goes on from the reference of another instance, which may have had another plan.
  void set_state(const GaitdIcpPlannerState& state) {
    state_ = state;
    resumed_ = true;
  }

  // One tick of `dt` seconds.
  void update(double dt, const GaitdRobotState& robot, const GaitdGaitState& gait,
              const CmpOffsets& offsets, GaitdIcpPlan& plan);

 private:
  const GaitdModel model_;
  IcpTrajectory trajectory_;
  static constexpr int kNotStarted = -1;  // plan_revision before the first tick
  GaitdIcpPlannerState state_{};
  bool resumed_ = false;
  Eigen::Vector2d otherwise_ = Eigen::Vector2d::Zero();  // m, of delta
};

}  // namespace gaitd::walking
