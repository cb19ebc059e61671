// SPDX-License-Identifier: Apache-2.0
// The way back to the commanded footholds after steps that had to leave them.
#include <algorithm>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/gait_machine.h"
#include "gaitd/walking/support.h"

namespace gaitd::walking {
namespace {

// Heights of the CoM, by which a step comes back to the commanded way at most.
constexpr double kMostBack = 0.1274;
constexpr double kArrived = 0.2;  // nominal distances of the feet

// m, of `offset` what leaves `next` in its landing region, where it has one.
Eigen::Vector3d in_region(const GaitdFootstep& next, const Eigen::Vector3d& offset) {
  if (next.region_count < 3) return offset;
  const Eigen::Vector2d told = sdk::view(next.pose.position).head<2>();
  const Eigen::Vector2d there = landing_region(next).closest_point(told + offset.head<2>());
  return {there.x() - told.x(), there.y() - told.y(), offset.z()};
}

}  // namespace

// Coming back at once would take steps that are too long for the legs.
Eigen::Vector3d GaitMachine::kept(const Eigen::Vector3d& shift) const {
  const double length = shift.norm();
  const double back = std::min((1.0 - kShiftKept) * length, kMostBack * scale_.length);
  return length > 0.0 ? Eigen::Vector3d(shift * (1.0 - back / length)) : shift;
}

Eigen::Vector3d GaitMachine::following(const Eigen::Vector3d& shift, const GaitdFootstep& next,
                                       const GaitdPose& stance) const {
  if (shift.isZero(0.0)) return shift;
  Eigen::Vector3d offset = kept(shift);
  const Eigen::Quaterniond heading =
      sdk::from_yaw(sdk::yaw_of(sdk::quaternion(stance.orientation)));
  const Eigen::Vector3d step =
      heading.conjugate() * (sdk::view(next.pose.position) + offset - sdk::view(stance.position));
  const double side = side_sign(next.side);
  const double lacking = closest_ - side * step.y();
  if (lacking > 0.0) offset += heading * Eigen::Vector3d(0.0, side * lacking, 0.0);
  return offset;
}

// The step that closes the feet is beside the one that caught the robot, wherever that landed.
Eigen::Vector3d GaitMachine::offset_of(int place, const Eigen::Vector3d& shift,
                                       const GaitdPose& stance) const {
  const GaitdFootstep& next = queue_[place];
  return place < own_steps_ ? shift : in_region(next, following(shift, next, stance));
}

Eigen::Vector3d GaitMachine::astray(int side) const {
  Eigen::Vector3d off =
      sdk::view(state_.footholds[side].pose.position) - sdk::view(goals_[side].step.pose.position);
  off.z() = 0.0;
  return off;
}

bool GaitMachine::comes_back() const {
  if (returns_left_ <= 0 || queue_.size() > 0 || state_.paused != 0 ||
      state_.mode != pending_mode_ || state_.mode == GAITD_MODE_STAND) {
    return false;
  }
  // On feet that bear on an edge, steps in place lead further away than they bring back.
  if (!rolls_foot(model_, GAITD_LEFT)) return false;
  return goals_[GAITD_LEFT].known && goals_[GAITD_RIGHT].known &&
         std::max(astray(GAITD_LEFT).norm(), astray(GAITD_RIGHT).norm()) > arrived();
}

double GaitMachine::arrived() const { return kArrived * model_.nominal_foot_separation; }

// All steps of the way at once, for a plan that knows what follows: a step that it took for the
// last one leaves the ICP between the feet, where no short transfer gets it over the next foot.
void GaitMachine::begin_return(const GaitdRobotState& robot) {
  double away[GAITD_MAX_FEET] = {astray(GAITD_LEFT).norm(), astray(GAITD_RIGHT).norm()};
  Eigen::Vector3d offset = 0.5 * (astray(GAITD_LEFT) + astray(GAITD_RIGHT));
  int side = recovery_side(robot, -offset.head<2>());
  GaitdPose stance = state_.footholds[other_side(side)].pose;
  while (returns_left_ > 0 && std::max(away[GAITD_LEFT], away[GAITD_RIGHT]) > arrived()) {
    GaitdFootstep step = goals_[side].step;
    // The ground was felt beside it; what is commanded is as far off as the map of who commands.
    step.pose.position[2] = state_.footholds[side].pose.position[2] - height_offset_;
    step.closing = 1;
    complete(step);
    queue_.push(step);
    --returns_left_;
    offset = in_region(step, following(offset, step, stance));
    if (queue_.size() == 1) path_offset_ = offset;
    away[side] = offset.norm();
    stance = step.pose;
    sdk::view(stance.position) += offset;
    side = other_side(side);
  }
  begin_transfer(robot, GAITD_BOTH);
}

}  // namespace gaitd::walking
