// SPDX-License-Identifier: Apache-2.0
// Steps that a standing robot takes by itself when its feet cannot hold it any more.
#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/gait_machine.h"
#include "gaitd/walking/support.h"

namespace gaitd::walking {
namespace {

// sqrt(h / g), swing of a step that catches the robot, and the transfer before it.
constexpr double kSwing = 1.3;
constexpr double kTransfer = 0.173;
constexpr double kPatience = 0.005;  // s, that the ICP has to be out of reach: no spike of a sensor
constexpr double kOnItsFeet = 0.5;   // of the weight on the feet: neither on a hoist nor in the air
constexpr double kSideways = 1.7;    // away sideways by this much more than along: a side step
// Heights of the CoM, of the ICP past the edge of the feet at which the robot steps: an ICP at the
// edge comes back as often as not.
constexpr double kPastEdge = 0.017;

}  // namespace

int GaitMachine::recovery_side(const GaitdRobotState& robot, const Eigen::Vector2d& away) const {
  const Eigen::Vector3d local = heading().conjugate() * Eigen::Vector3d(away.x(), away.y(), 0.0);
  if (std::abs(local.y()) > kSideways * std::abs(local.x())) {
    return local.y() > 0.0 ? GAITD_LEFT : GAITD_RIGHT;
  }
  // The foot that is further back on the way; side by side, the one with less load.
  const Eigen::Vector2d apart = (sdk::view(state_.footholds[GAITD_LEFT].pose.position) -
                                 sdk::view(state_.footholds[GAITD_RIGHT].pose.position))
                                    .head<2>();
  const double left_ahead = apart.dot(away.normalized());
  if (std::abs(left_ahead) > 0.5 * model_.nominal_foot_separation) {
    return left_ahead > 0.0 ? GAITD_RIGHT : GAITD_LEFT;
  }
  return robot.feet[GAITD_LEFT].normal_force < robot.feet[GAITD_RIGHT].normal_force ? GAITD_LEFT
                                                                                    : GAITD_RIGHT;
}

GaitdFootstep GaitMachine::recovery_step(const GaitdRobotState& robot, int side) const {
  // Where the ICP will be when the foot comes down, with the CMP as far out as the stance foot
  // allows; no further than a step reaches, and never across the other leg.
  const GaitdFoothold& stance = state_.footholds[other_side(side)];
  ConvexPolygon sole;
  add_foothold(stance, model_.feet[other_side(side)].toe_point, sole);
  sole.make_hull();
  const Eigen::Vector2d icp = sdk::view(robot.icp);
  const Eigen::Vector2d cmp = sole.closest_point(icp);
  const double time = (kSwing + kTransfer) * scale_.time;
  const Eigen::Vector2d coming = cmp + std::exp(state_.omega * time) * (icp - cmp);

  GaitdFootstep step{};
  step.side = side;
  step.closing = 1;
  step.pose = state_.footholds[side].pose;
  const Eigen::Quaterniond heading =
      sdk::from_yaw(sdk::yaw_of(sdk::quaternion(stance.pose.orientation)));
  const Eigen::Vector3d middle = sdk::view(stance.pose.position);
  Eigen::Vector3d local =
      heading.conjugate() * Eigen::Vector3d(coming.x() - middle.x(), coming.y() - middle.y(), 0.0);
  const StepLimits most = limits();
  local.x() = std::clamp(local.x(), -most.backward, most.forward);
  const double nearest = model_.nominal_foot_separation;
  local.y() = side_sign(side) * std::clamp(side_sign(side) * local.y(), nearest,
                                           std::max(nearest, most.largest_separation));
  sdk::view(step.pose.position).head<2>() = (middle + heading * local).head<2>();
  step.pose.position[2] -= height_offset_;
  sdk::store(heading, step.pose.orientation);
  step.swing_duration = kSwing * scale_.time;
  step.transfer_duration = kTransfer * scale_.time;
  return step;
}

bool GaitMachine::recover(double dt, const GaitdRobotState& robot) {
  const double load = robot.feet[GAITD_LEFT].normal_force + robot.feet[GAITD_RIGHT].normal_force;
  const ConvexPolygon feet = support_region(model_, state_, robot);
  const Eigen::Vector2d icp = sdk::view(robot.icp);
  const bool held = feet.inside_distance(icp) >= -kPastEdge * scale_.length;
  if (held || load < kOnItsFeet * model_.total_mass * model_.gravity) {
    time_unheld_ = 0.0;
    return false;
  }
  time_unheld_ += dt;
  if (!parameters_.flag(Gait::kRecovery) || time_unheld_ < kPatience) return false;
  time_unheld_ = 0.0;
  const Eigen::Vector2d away = icp - feet.closest_point(icp);
  const int side = recovery_side(robot, away);
  GaitdFootstep step = recovery_step(robot, side);
  complete(step);
  GaitdFootstep closing = closing_step(step.pose, other_side(side));
  complete(closing);
  // Footsteps that waited for a resume begin from a place where the robot no longer is. The pause
  // lasts: what is sent now waits, too.
  keep_first(0);
  queue_.push(step);
  queue_.push(closing);
  own_steps_ = queue_.size();
  // A foot that is pushed over its own edge has not found an edge of the ground.
  for (FootContact& contact : contacts_) contact.doubt();
  begin_transfer(robot, GAITD_BOTH);
  return true;
}

bool GaitMachine::closed() const {
  const Eigen::Vector3d goal = sdk::view(queue_[0].pose.position) + path_offset_;
  const Eigen::Vector3d gap = sdk::view(state_.footholds[queue_[0].side].pose.position) - goal;
  return gap.head<2>().norm() < arrived();
}

}  // namespace gaitd::walking
