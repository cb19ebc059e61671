// SPDX-License-Identifier: Apache-2.0
// What the feet are told: those that stand, on the sole or on the toe, and the one in swing.
#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/objectives.h"
#include "gaitd/walking/support.h"
#include "objective_terms.h"

namespace gaitd::walking {
namespace {

using sdk::view;

constexpr double kTouchdownTime = 0.05;    // s, in which the touchdown damping fades
constexpr double kClosingTouchdown = 0.5;  // of the touchdown velocity
constexpr double kNever = 1e9;             // rad
// Of a basis vector of a contact, weights: enough for friction to hold the foot, and more than any
// landing needs.
constexpr double kRhoMin = 0.0023;
constexpr double kRhoMax = 1.5;
constexpr double kContactMargin = 0.09;  // half extents, of one foot that carries a straight leg
// rad, tilt of a sole in contact from which it bears less and less as a whole, and on a line.
constexpr double kTiltStart = 0.015;
constexpr double kTiltFull = 0.04;
constexpr double kTiltStiffness = 150.0;  // 1/s^2, with which it comes back
// 1/s, of the twist of a foot in contact, and in the first moments after touchdown.
constexpr double kStanceDamping = 3.0;
constexpr double kTouchdownDamping = 30.0;
constexpr double kStanceWeight = 1000.0;  // a foot in contact does not move
constexpr double kToeStiffness = 100.0;   // 1/s^2, holds the toe point in toe-off
constexpr double kToeWeight = 50.0;
constexpr double kToeAngularStiffness = 200.0;  // 1/s^2, roll and yaw of the foot in toe-off
constexpr double kToeAngularWeight = 5.0;
constexpr double kToeDamping = 0.4;          // of both
constexpr double kSwingDamping = 0.7;        // of the swing foot
constexpr double kSwingUpright = 4.0 / 3.0;  // stiffness of height and orientation, over the rest
// Of the orientation, however much the position weighs: at a stop of the ankle it tilts the pelvis.
constexpr double kSwingAngularWeight = 2.0;
constexpr double kToeEdge = 0.01;  // m, points this far behind the toe point are not on the edge

// Of a point of the sole, in the axes of the body of the foot.
Eigen::Vector3d point_in_body(const GaitdFoot& foot, const Eigen::Vector3d& in_sole) {
  return view(foot.sole.origin) + sdk::quaternion(foot.sole.orientation) * in_sole;
}

// One straight leg carries the robot. A sole that tilts then stays tilted: the knee has no way to
// give. Bent legs bring it back by themselves, and need the edges of the sole against pushes; with
// two feet on the ground the other one takes the load.
bool stiff_alone(const GaitdGaitState& gait) {
  return gait.phase == GAITD_PHASE_SWING && gait.mode == GAITD_MODE_WALK_STRAIGHT;
}

}  // namespace

void ObjectiveBuilder::update_rests(double dt, const GaitdRobotState& robot,
                                    const GaitdGaitState& gait, const GaitdToeOff& toe_off) {
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    if (gait.footholds[side].contact == GAITD_CONTACT_NONE || on_toe(side)) {
      rests_[side].reset();
      continue;
    }
    const bool flat = stiff_alone(gait) && toe_off.active == 0 && rolls_foot(model_, side);
    const double start = flat ? kTiltStart : kNever;
    rests_[side].update(dt, robot.feet[side], gait.footholds[side], weight_, {start, kTiltFull});
  }
}

bool ObjectiveBuilder::on_toe(int side) const { return time_in_toe_off_[side] > kToeRamp; }

double ObjectiveBuilder::load_share(int side, const GaitdGaitState& gait) const {
  double share = std::min(1.0, time_in_contact_[side] / kContactRamp);
  const bool leaving =
      gait.phase == GAITD_PHASE_TRANSFER && gait.transfer_final == 0 && gait.next_side == side;
  // A transfer that waits for the ICP past its time needs both feet.
  const bool waiting = gait.time_in_phase > gait.phase_duration;
  if (leaving && !waiting) share = std::min(share, gait.time_remaining / kContactRamp);
  return std::clamp(share, 0.0, 1.0);
}

void ObjectiveBuilder::update_contacts(double dt, const GaitdRobotState& robot,
                                       const GaitdGaitState& gait, const GaitdToeOff& toe_off,
                                       GaitdObjectives& out) const {
  const double rho_max = kRhoMax * weight_;
  const double rho_min = kRhoMin * weight_;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdFoothold& foothold = gait.footholds[side];
    if (foothold.contact == GAITD_CONTACT_NONE) continue;
    const GaitdFoot& foot = model_.feet[side];
    const bool toe = on_toe(side);
    // On the way onto the toe the points behind it carry less and less.
    const double unloaded = time_in_toe_off_[side] / std::max(kToeRamp, dt);
    const Eigen::Quaterniond sole = sdk::quaternion(foothold.pose.orientation);
    const double share = load_share(side, gait);
    const int points = toe ? 1 : foothold.polygon_count;
    const double used = stiff_alone(gait) ? 1.0 - kContactMargin : 1.0;
    const Eigen::Vector2d middle = sole_middle(foothold);
    const bool rolls = rolls_foot(model_, side);
    const double line = rolls ? 0.0 : bearing_line(model_, side, robot.feet[side]);
    for (int i = 0; i < points && out.contact_count < GAITD_MAX_CONTACTS; ++i) {
      GaitdContactPoint& c = out.contacts[out.contact_count++];
      c = {};  // it may have been that of a hand
      c.side = side;
      c.body = foot.body;
      Eigen::Vector3d in_sole = view(toe_off.toe_point);
      if (!toe) {
        const Eigen::Vector2d corner = view(foothold.contact_polygon[i]);
        Eigen::Vector2d p = middle + used * (corner - middle);
        if (!rolls) p.y() = line;
        in_sole << rests_[side].bearing_point(p), 0.0;
      }
      view(c.point) = point_in_body(foot, in_sole);
      view(c.normal) = sole * Eigen::Vector3d::UnitZ();
      view(c.tangent) = sole * Eigen::Vector3d::UnitX();
      c.friction = parameters_[Objective::kFriction];
      const bool behind = in_sole.x() < toe_off.toe_point[0] - kToeEdge;
      const double rest = behind ? std::max(0.0, 1.0 - unloaded) : 1.0;
      c.rho_max = std::max(share * share * rest * rest * rho_max, 1e-3);
      c.rho_min = std::min(rho_min, 0.5 * c.rho_max);
    }
  }
}

void ObjectiveBuilder::update_feet(const GaitdRobotState& robot, const GaitdGaitState& gait,
                                   const GaitdToeOff& toe_off, GaitdObjectives& out) {
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    if (gait.footholds[side].contact == GAITD_CONTACT_NONE) {
      add_swing_foot(side, robot, gait, out);
    } else if (on_toe(side)) {
      add_toe(side, robot, gait, toe_off, out);
    } else {
      add_stance_foot(side, robot, out);
    }
  }
}

void ObjectiveBuilder::add_stance_foot(int side, const GaitdRobotState& robot,
                                       GaitdObjectives& out) const {
  const GaitdFoot& foot = model_.feet[side];
  GaitdTask& task = add_task(out, GAITD_TASK_FRAME, foot.body, kAllRows);
  const SoleRest& rest = rests_[side];
  Eigen::Vector3d pivot;
  pivot << rest.pivot(), 0.0;
  view(task.point) = point_in_body(foot, pivot);
  constexpr double kExtra = kTouchdownDamping - kStanceDamping;
  const double rate = kStanceDamping + kExtra * std::exp(-time_in_contact_[side] / kTouchdownTime);
  sdk::Vector6d twist = view(robot.feet[side].twist);
  const Eigen::Vector3d turn = twist.head<3>();
  twist.tail<3>() += turn.cross(sdk::quaternion(robot.feet[side].orientation) * pivot);
  view(task.acceleration) = -rate * twist;
  view(task.acceleration).head<3>() +=
      rest.share() * (kTiltStiffness * rest.way_back() -
                      std::max(0.0, damping(kTiltStiffness, 1.0) - rate) * turn);
  auto stop = view(task.acceleration).tail<3>();
  if (stop.norm() > kTouchdownStop) stop *= kTouchdownStop / stop.norm();
  view(task.weight).setConstant(kStanceWeight);
  if (!rolls_foot(model_, side)) {
    leave_roll_free(sdk::quaternion(robot.feet[side].orientation), task);
  }
}

void ObjectiveBuilder::add_toe(int side, const GaitdRobotState& robot, const GaitdGaitState& gait,
                               const GaitdToeOff& toe_off, GaitdObjectives& out) const {
  const GaitdFoot& foot = model_.feet[side];
  const Eigen::Vector3d in_sole = view(toe_off.toe_point);
  const Eigen::Vector3d in_body = point_in_body(foot, in_sole);
  const GaitdPose& hold = gait.footholds[side].pose;
  // The point is held where the foothold has it; rows along the axes of the foothold.
  GaitdTask& point = add_task(out, GAITD_TASK_FRAME, foot.body, kLinearRows);
  view(point.point) = in_body;
  view(point.acceleration).tail<3>() =
      kToeStiffness *
          (sdk::transform(hold, in_sole) - kinematics_.frame_position(foot.body, in_body)) -
      damping(kToeStiffness, kToeDamping) *
          kinematics_.frame_velocity(foot.body, in_body).tail<3>();
  view(point.weight).setConstant(kToeWeight);
  // Roll and yaw of the sole are held; its pitch has no row at all, but for a foot that has to come
  // back because no step follows.
  const bool stays = gait.phase == GAITD_PHASE_STAND || gait.transfer_final != 0 ||
                     (gait.phase == GAITD_PHASE_TRANSFER && gait.next_side != side);
  GaitdTask& turn = add_task(out, GAITD_TASK_FRAME, foot.body, stays ? kAngularRows : 0b000101);
  if (!rolls_foot(model_, side)) turn.row_mask &= ~kRollRow;
  view(turn.point) = in_body;
  const Eigen::Quaterniond now = sdk::quaternion(robot.feet[side].orientation);
  sdk::store(now, turn.axes);
  const Eigen::Vector3d error =
      now.conjugate() * rotation_error(sdk::quaternion(hold.orientation), now);
  const Eigen::Vector3d rate = now.conjugate() * view(robot.feet[side].twist).head<3>();
  view(turn.acceleration).head<3>() =
      kToeAngularStiffness * error - damping(kToeAngularStiffness, kToeDamping) * rate;
  view(turn.weight).setConstant(kToeAngularWeight);
}

void ObjectiveBuilder::plan_swing(const GaitdRobotState& robot, const GaitdGaitState& gait,
                                  const GaitdPose& lift_off) {
  if (gait.phase != GAITD_PHASE_SWING) return;
  const int side = gait.next_side;
  const GaitdFootstep& goal = gait.adjusted[0];
  SwingShape swing = swing_shape(model_, swing_parameters_);
  if (goal.closing != 0) {
    // Nothing follows: there is time to meet the ground gently.
    swing.landing_speed *= kClosingTouchdown;
  }
  if (swing_step_ != gait.step_index) {
    swing_.begin(lift_off, view(robot.feet[side].twist), gait.footholds[side].pose.position[2],
                 goal, gait.phase_duration, swing);
    swing_step_ = gait.step_index;
    swing_revision_ = gait.plan_revision;
  } else if (swing_revision_ != gait.plan_revision) {
    swing_.replan(gait.time_in_phase, goal, gait.phase_duration, swing);
    swing_revision_ = gait.plan_revision;
  }
}

void ObjectiveBuilder::add_swing_foot(int side, const GaitdRobotState& robot,
                                      const GaitdGaitState& gait, GaitdObjectives& out) {
  const SwingTrajectory::Sample s = swing_.evaluate(gait.time_in_phase);
  const GaitdFoot& foot = model_.feet[side];
  const GaitdFootState& now = robot.feet[side];
  GaitdTask& task = add_task(out, GAITD_TASK_FRAME, foot.body, kAllRows);
  view(task.point) = view(foot.sole.origin);
  const double kp_xy = parameters_[Objective::kSwingStiffness];
  const double kp_z = kSwingUpright * kp_xy;
  const Eigen::Vector3d kp(kp_xy, kp_xy, kp_z);
  const Eigen::Vector3d kd(damping(kp_xy, kSwingDamping), damping(kp_xy, kSwingDamping),
                           damping(kp_z, kSwingDamping));
  const auto twist = view(now.twist);
  view(task.acceleration).tail<3>() = s.acceleration +
                                      kp.cwiseProduct(s.position - view(now.position)) +
                                      kd.cwiseProduct(s.velocity - twist.tail<3>());
  view(task.acceleration).head<3>() =
      s.angular_acceleration +
      kp_z * rotation_error(s.orientation, sdk::quaternion(now.orientation)) +
      damping(kp_z, kSwingDamping) * (s.angular_velocity - twist.head<3>());
  view(task.weight).head<3>().setConstant(kSwingAngularWeight);
  view(task.weight).tail<3>().setConstant(parameters_[Objective::kSwingWeight]);
  if (!rolls_foot(model_, side)) leave_roll_free(sdk::quaternion(now.orientation), task);
}

}  // namespace gaitd::walking
