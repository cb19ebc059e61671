// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/objectives.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gaitd/sdk/loads.h"
#include "gaitd/sdk/views.h"
#include "gaitd/walking/external_wrench.h"
#include "gaitd/walking/hip_descent.h"
#include "gaitd/walking/support.h"
#include "objective_terms.h"

namespace gaitd::walking {
namespace {

using sdk::view;

// Over sqrt(g / h), of the reference filter of the CoM height: a faster one disturbs steps that
// catch a light robot. Where the hip goes down with a foot it has to be fast enough for a foot that
// finds no ground.
constexpr double kHeightRate = 2.3;
constexpr double kDescentRate = 5.4;
constexpr double kLevelRate = 1.0;     // 1/s, with which a walk levels the pelvis
constexpr double kLowestStand = 0.75;  // of the nominal height, also with a pose that lowers it
constexpr double kShortestLeg = 0.3;   // of its length
constexpr double kShortStep = 0.2;     // leg lengths: a leg reaches so far with its sole flat
// Of the tasks: the height and the pelvis come to rest without an overshoot.
constexpr double kHeightDamping = 1.0;
constexpr double kTrunkDamping = 0.8;
constexpr double kAngularFull = 0.05;  // leg lengths, of an excursion of the CMP that weighs fully
constexpr double kHeightAcceleration = 0.5;  // g, that the height may ask for: feet keep their grip
constexpr double kAccelerationWeight = 0.05;  // what no task decides stays where it is
// While a touchdown is overdue the pelvis may turn so far towards the foot, rad.
constexpr double kPelvisRoll = 0.3;
constexpr double kPelvisYaw = 0.2;
// A leg at the end of a transfer reaches back as long as in the nominal posture; the hip is then so
// much of the step ahead of its ankle, and comes down for it by so many heights of the CoM at most.
constexpr double kReachShare = 0.9;
constexpr double kReachDrop = 0.1;
constexpr double kAnkleMargin = 0.05;  // rad, before the stop of an ankle whose knee bends
constexpr double kYawRate = 6.0;       // 1/s, of the reference filter of the heading

// Heading that the body turns to: half-way between the feet it will stand on next.
double heading_target(const GaitdGaitState& gait) {
  const double left = heading(gait.footholds[GAITD_LEFT].pose);
  const double right = heading(gait.footholds[GAITD_RIGHT].pose);
  if (gait.phase != GAITD_PHASE_SWING) return mean_heading(left, right);
  return mean_heading(heading(gait.footholds[gait.support].pose), heading(gait.adjusted[0].pose));
}

// s, for which the touchdown is overdue.
double late_time(const GaitdGaitState& gait) {
  return gait.phase == GAITD_PHASE_SWING ? std::max(0.0, gait.time_in_phase - gait.phase_duration)
                                         : 0.0;
}

}  // namespace

ObjectiveBuilder::ObjectiveBuilder(const GaitdModel& model)
    : model_(model),
      weight_(model.total_mass * model.gravity),
      scale_(model),
      kinematics_(model),
      self_collision_(model) {
  std::copy_n(model_.nominal_position, GAITD_MAX_JOINTS, references_.joint_position);
  kinematics_.update(Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity(), sdk::Vector6d::Zero(),
                     sdk::head(model_.nominal_position, model_.joint_count),
                     Eigen::VectorXd::Zero(model_.joint_count));
  chest_in_pelvis_ = Eigen::Quaterniond(kinematics_.R_WB(model_.chest_body));
  const GaitdLeg& leg = model_.legs[GAITD_LEFT];
  const Eigen::Vector3d hip = kinematics_.p_WB(model_.joints[leg.hip_pitch].child_body);
  const Eigen::Vector3d ankle = kinematics_.p_WB(model_.joints[leg.ankle_pitch].child_body);
  leg_length_ = (hip - ankle).norm();
  const GaitdFoot& foot = model_.feet[GAITD_LEFT];
  const Eigen::Vector3d sole = kinematics_.frame_position(foot.body, view(foot.sole.origin));
  const double hip_ahead = hip.x() - kinematics_.com().x() + sole.x() - ankle.x();
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    legs_[side].set_leg(model_, side, hip_ahead);
    const GaitdFoot& f = model_.feet[side];
    ankle_in_sole_[side] =
        this->ankle(side) - kinematics_.frame_position(f.body, view(f.sole.origin));
  }
  posture_joint_.fill(false);
  for (int i = 0; i < model_.joint_count; ++i) posture_joint_[i] = true;
  for (const GaitdLeg& l : model_.legs) {
    for (int i = 0; i < l.joint_count; ++i) posture_joint_[l.joints[i]] = false;
  }
  for (int body = model_.chest_body; body > 0; body = model_.bodies[body].parent) {
    posture_joint_[model_.bodies[body].joint] = false;
  }
}

void ObjectiveBuilder::reset(const GaitdRobotState& robot, const GaitdGaitState& gait) {
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdLeg& leg = model_.legs[side];
    legs_[side].reset(legs_[side].geometry().bend(robot.joint_position[leg.knee]));
    time_in_contact_[side] = 1e3;
    time_in_toe_off_[side] = 0.0;
  }
  swing_step_ = -1;
  held_arm_offset_.fill(0.0);
  pelvis_share_ = 1.0;
  mode_ = gait.mode;
  height_.reset(robot.com[2], robot.com_velocity[2]);
  lowering_.reset(leg_parameters_[Legs::kStraightKnee]);
  lowered_side_ = GAITD_BOTH;
  const Eigen::Quaterniond pelvis = sdk::quaternion(robot.pelvis_orientation);
  yaw_.reset(sdk::yaw_of(pelvis));
  tilt_ = sdk::log_so3(sdk::from_yaw(-yaw_.value()) * pelvis);
}

void ObjectiveBuilder::update(double dt, const GaitdRobotState& robot, const GaitdGaitState& gait,
                              const GaitdPose& lift_off, const GaitdStepAdjustment& adjustment,
                              const GaitdToeOff& toe_off, GaitdObjectives& out) {
  kinematics_.update(robot);
  out.size = sizeof(out);
  out.task_count = 0;
  out.contact_count = 0;
  out.rho_weight = parameters_[Objective::kRhoWeight] / (weight_ * weight_);
  out.rho_rate_weight =
      parameters_[Objective::kRhoRateWeight] / (weight_ * weight_) * (1e-3 / dt) * 1e3;
  out.acceleration_weight = kAccelerationWeight;
  view(out.external_wrench) = view(robot.external_wrench);
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const bool touching = gait.footholds[side].contact != GAITD_CONTACT_NONE;
    time_in_contact_[side] = touching ? time_in_contact_[side] + dt : 0.0;
    const bool toe = toe_off.active != 0 && toe_off.side == side;
    time_in_toe_off_[side] = toe ? time_in_toe_off_[side] + dt : 0.0;
  }
  plan_swing(robot, gait, lift_off);
  update_rests(dt, robot, gait, toe_off);
  update_contacts(dt, robot, gait, toe_off, out);
  update_momentum(dt, robot, gait, adjustment, out);
  update_held_arms(dt, robot);
  update_upper_body(dt, gait, out);
  update_posture(robot, out);
  update_feet(robot, gait, toe_off, out);
  add_hands(robot, out);
  update_privileged(dt, robot, gait, out);
  update_impedance(gait, out);
  self_collision_.update(kinematics_, out);
}

void ObjectiveBuilder::update_momentum(double dt, const GaitdRobotState& robot,
                                       const GaitdGaitState& gait,
                                       const GaitdStepAdjustment& adjustment,
                                       GaitdObjectives& out) {
  const double mass = sdk::total_mass(model_, robot.loads);
  // No higher than on straight legs.
  const LegGeometry& leg = legs_[GAITD_LEFT].geometry();
  const double highest =
      model_.nominal_com_height +
      std::max(0.0, leg.length(leg_parameters_[Legs::kStraightKnee]) - leg_length_);
  const double standing =
      std::min(parameters_[Objective::kComHeight] * model_.nominal_com_height, highest);
  const LegReach reach{.standing_height = standing,
                       .leg_length = leg_length_ - (model_.nominal_com_height - standing),
                       .longest = leg_length_,
                       .trailing_share = kReachShare,
                       .nominal_separation = model_.nominal_foot_separation,
                       .largest_drop = kReachDrop * model_.nominal_com_height};
  const double room = std::min(0.0, kLowestStand * model_.nominal_com_height - standing);
  out.height_target = com_height_target(gait, reach) + std::max(references_.com_shift[2], room);
  const bool straight = gait.mode == GAITD_MODE_WALK_STRAIGHT;
  bool descends = false;
  if (gait.phase == GAITD_PHASE_SWING && !straight) {
    const double landing = legs_[gait.next_side].geometry().length(
        LegConfiguration::kLandingKnee * leg_parameters_[Legs::kBentKnee]);
    const double hip = highest_hip_of_swing(robot, gait, landing, reach.longest);
    const double above = standing - leg_length_ - ankle_in_sole_[gait.next_side].z();
    descends = hip + above < out.height_target;
    if (descends) out.height_target = hip + above;
  }
  if (gait.mode != mode_) height_.reset(robot.com[2], robot.com_velocity[2]);
  mode_ = gait.mode;
  height_.update(dt, out.height_target, (descends ? kDescentRate : kHeightRate) / scale_.time);
  // A controller that commands the height of straight legs as well is drawn to it softly.
  const double stiffness = (straight ? 0.5 : 1.0) * parameters_[Objective::kHeightStiffness];
  const double limit = kHeightAcceleration * model_.gravity;
  const double wanted =
      height_.acceleration() + stiffness * (height_.value() - robot.com[2]) +
      damping(stiffness, kHeightDamping) * (height_.velocity() - robot.com_velocity[2]);
  view(out.momentum_rate).head<3>() = view(adjustment.angular_momentum_rate);
  // Of the ground, as the adjuster asks, and of what pulls beside it.
  const Eigen::Vector2d pull = lean(view(robot.external_wrench), mass, model_.gravity, gait.omega);
  view(out.momentum_rate).segment<2>(3) =
      view(adjustment.linear_momentum_rate) + mass * gait.omega * gait.omega * pull;
  out.momentum_rate[5] = mass * std::clamp(wanted, -limit, limit);
  // A little angular momentum weighs little: torques would jump whenever some is asked for.
  const double asked = view(adjustment.angular_momentum_rate).norm() / (weight_ * leg_length_);
  const double angular = std::min(1.0, asked / kAngularFull) / (leg_length_ * leg_length_);
  for (int i = 0; i < 6; ++i) {
    out.momentum_weight[i] =
        (i < 3 ? angular : 1.0) * parameters_[Objective::kMomentumWeight] / (mass * mass);
  }
  out.momentum_mask =
      (static_cast<std::uint32_t>(adjustment.angular_momentum_mask) & kAngularRows) |
      (straight ? 0b011000u : kLinearRows);
}

GaitdTask& ObjectiveBuilder::add_task(GaitdObjectives& out, int type, int index,
                                      std::uint32_t mask) const {
  // Pelvis, chest and at most two for each foot: always room.
  GaitdTask& task = out.tasks[std::min<int>(out.task_count, GAITD_MAX_TASKS - 1)];
  if (out.task_count < GAITD_MAX_TASKS) ++out.task_count;
  task = {};
  task.type = type;
  task.index = index;
  task.row_mask = mask;
  task.axes[3] = 1.0;
  return task;
}

void ObjectiveBuilder::add_orientation_task(int body, const Eigen::Quaterniond& goal,
                                            const Eigen::Vector3d& goal_rate, double stiffness,
                                            double damping_ratio, double weight,
                                            GaitdObjectives& out) const {
  GaitdTask& task = add_task(out, GAITD_TASK_FRAME, body, kAngularRows);
  const Eigen::Quaterniond now(kinematics_.R_WB(body));
  const Eigen::Vector3d rate = kinematics_.body_twist(body).head<3>();
  view(task.acceleration).head<3>() = stiffness * rotation_error(goal, now) +
                                      damping(stiffness, damping_ratio) * (goal_rate - rate);
  view(task.weight).head<3>().setConstant(weight);
}

// While a touchdown is overdue the pelvis may turn towards the foot, up to a limit; afterwards it
// comes back as slowly as it went.
double ObjectiveBuilder::pelvis_weight(double dt, const GaitdGaitState& gait,
                                       const Eigen::Quaterniond& goal) {
  const double full = parameters_[Objective::kPelvisWeight];
  double share = 1.0;
  if (const double late = late_time(gait); late > 0.0) {
    const Eigen::Vector3d turned =
        sdk::log_so3(goal.conjugate() * Eigen::Quaterniond(kinematics_.R_WB(0)));
    const double used =
        std::max(std::abs(turned.x()) / kPelvisRoll, std::abs(turned.z()) / kPelvisYaw);
    share = std::clamp(std::max(1.0 - late / kPelvisFade, used), 0.05, 1.0);
  }
  pelvis_share_ = std::min(share, pelvis_share_ + dt / kPelvisFade);
  return full * pelvis_share_;
}

void ObjectiveBuilder::update_upper_body(double dt, const GaitdGaitState& gait,
                                         GaitdObjectives& out) {
  // Unwrapped, so that the filter never turns the long way round.
  const double target = heading_target(gait);
  yaw_.update(dt, yaw_.value() + std::remainder(target - yaw_.value(), 2.0 * M_PI), kYawRate);
  if (gait.phase != GAITD_PHASE_STAND) tilt_ *= std::max(0.0, 1.0 - kLevelRate * dt);
  const Eigen::Quaterniond goal = sdk::from_yaw(yaw_.value()) * sdk::exp_so3(tilt_);
  const Eigen::Vector3d rate(0.0, 0.0, yaw_.velocity());
  const Eigen::Quaterniond facing = sdk::from_yaw(yaw_.value());
  const auto turned = [&](const double(&turn)[4]) {
    const Eigen::Quaterniond q = sdk::quaternion(turn);
    return q.vec().isZero(0.0) ? goal : facing * q * facing.conjugate() * goal;
  };
  const GaitdTaskReferences& r = references_;
  const Eigen::Quaterniond pelvis = turned(r.pelvis_turn);
  add_orientation_task(0, pelvis, rate + facing * view(r.pelvis_turn_rate),
                       parameters_[Objective::kPelvisStiffness], kTrunkDamping,
                       pelvis_weight(dt, gait, pelvis), out);
  if (model_.chest_body > 0) {
    add_orientation_task(model_.chest_body, turned(r.chest_turn) * chest_in_pelvis_,
                         rate + facing * view(r.chest_turn_rate),
                         parameters_[Objective::kChestStiffness], kTrunkDamping,
                         parameters_[Objective::kChestWeight], out);
  }
}

Eigen::Vector3d ObjectiveBuilder::hip(int side) const {
  return kinematics_.p_WB(model_.joints[model_.legs[side].hip_pitch].child_body);
}

Eigen::Vector3d ObjectiveBuilder::ankle(int side) const {
  return kinematics_.p_WB(model_.joints[model_.legs[side].ankle_pitch].child_body);
}

double ObjectiveBuilder::highest_hip_of_swing(const GaitdRobotState& robot,
                                              const GaitdGaitState& gait, double longest,
                                              double longest_down) const {
  const GaitdPose& stance = gait.footholds[gait.support].pose;
  return highest_hip(swing_, gait.time_in_phase, gait.phase_duration,
                     {.hip = hip(gait.next_side),
                      .ankle_in_sole = ankle_in_sole_[gait.next_side],
                      .longest = longest,
                      .longest_down = longest_down,
                      .ground = stance.position[2],
                      .lever = Eigen::Vector3d(view(robot.com) - view(stance.position)).head<2>(),
                      .velocity = Eigen::Vector3d(view(robot.com_velocity)).head<2>(),
                      .omega = gait.omega,
                      .gravity = model_.gravity});
}

double ObjectiveBuilder::highest_hip_of_transfer(const GaitdRobotState& robot,
                                                 const GaitdGaitState& gait) const {
  const bool swing = gait.phase == GAITD_PHASE_SWING;
  const int leading = swing ? gait.next_side : other_side(gait.next_side);
  const int trailing = other_side(leading);
  const GaitdPose& from = gait.footholds[trailing].pose;
  const GaitdPose& to = swing ? gait.adjusted[0].pose : gait.footholds[leading].pose;
  const Eigen::Vector3d step =
      sdk::quaternion(from.orientation).conjugate() * (view(to.position) - view(from.position));
  // The heel of a leg that is left behind comes up, and a short way every leg reaches.
  const double sideways = std::max(std::abs(step.y()) - model_.nominal_foot_separation, 0.0);
  const double shortest = kShortStep * leg_length_;
  if (std::hypot(std::min(step.x(), 0.0), sideways) < shortest) {
    return std::numeric_limits<double>::max();
  }
  const double yaw = sdk::yaw_of(sdk::quaternion(from.orientation));
  return highest_hip(TrailingLeg{
      .hip = hip(trailing),
      .ankle = ankle(trailing),
      .heading = {std::cos(yaw), std::sin(yaw)},
      .flat = shortest,
      .longest = legs_[trailing].geometry().length(leg_parameters_[Legs::kStraightKnee]),
      .lever = Eigen::Vector3d(view(robot.com) - view(from.position)).head<2>(),
      .velocity = Eigen::Vector3d(view(robot.com_velocity)).head<2>(),
      .swing = swing ? std::max(gait.time_remaining, 0.0) : 0.0,
      .transfer = swing ? gait.adjusted[1].transfer_duration : std::max(gait.time_remaining, 0.0),
      .omega = gait.omega,
      .gravity = model_.gravity});
}

void ObjectiveBuilder::update_lowering(double dt, const GaitdRobotState& robot,
                                       const GaitdGaitState& gait) {
  const double straight = leg_parameters_[Legs::kStraightKnee];
  const bool swing = gait.phase == GAITD_PHASE_SWING;
  // From a stand, too: with its feet apart, the leg that leaves has as far to reach.
  const bool transfer = gait.phase == GAITD_PHASE_TRANSFER && gait.transfer_final == 0 &&
                        (gait.trailing_side == gait.next_side || gait.trailing_side == GAITD_BOTH);
  const int standing = swing ? gait.support : transfer ? other_side(gait.next_side) : GAITD_BOTH;
  if (standing == GAITD_BOTH) {
    lowering_.reset(straight);
    lowered_side_ = standing;
    return;
  }
  if (standing != lowered_side_) lowering_.reset(straight);
  lowered_side_ = standing;
  const LegGeometry& leg = legs_[standing].geometry();
  const double longest = leg.length(straight);
  const Eigen::Vector3d foot = ankle(standing);
  double high = std::numeric_limits<double>::max();
  if (swing) high = highest_hip_of_swing(robot, gait, longest, longest);
  if (transfer || gait.footstep_count > 1) {
    high = std::min(high, highest_hip_of_transfer(robot, gait));
  }
  high -= foot.z();
  const double rate = kDescentRate / scale_.time;
  Eigen::Vector2d hip_now = hip(standing).head<2>();
  // Vaults over its foot, by as much as the filter is behind.
  if (transfer) hip_now += 2.0 / rate * Eigen::Vector3d(view(robot.com_velocity)).head<2>();
  const double behind = (hip_now - foot.head<2>()).norm();
  const double length = std::hypot(behind, std::max(high, kShortestLeg * longest));
  lowering_.update(dt, leg.knee(std::min(longest, length)), rate);
}

// rad, by which the ankle of a leg that bends may still give way: as far as half of the knee.
double ObjectiveBuilder::ankle_room(int side, const GaitdRobotState& robot) const {
  const GaitdLeg& leg = model_.legs[side];
  const GaitdJoint& ankle = model_.joints[leg.ankle_pitch];
  const double at = robot.joint_position[leg.ankle_pitch];
  const double room =
      leg.ankle_pitch_bend_sign > 0 ? ankle.position_max - at : at - ankle.position_min;
  return room - kAnkleMargin;
}

void ObjectiveBuilder::update_privileged(double dt, const GaitdRobotState& robot,
                                         const GaitdGaitState& gait, GaitdObjectives& out) {
  for (int i = 0; i < GAITD_MAX_JOINTS; ++i) {
    out.privileged_acceleration[i] = 0.0;
    out.privileged_weight[i] = 0.0;
  }
  update_lowering(dt, robot, gait);
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdLeg& leg = model_.legs[side];
    const double knee = legs_[side].geometry().bend(robot.joint_position[leg.knee]);
    const double rate = leg.knee_bend_sign * robot.joint_velocity[leg.knee];
    const LegConfiguration::Reference& r =
        legs_[side].update(dt, side, knee, rate, lowering_, knee + 2.0 * ankle_room(side, robot),
                           gait, leg_parameters_);
    // The leg acts as a unit: half the knee to hip and ankle each keeps the direction of the
    // line from hip to ankle (theory section 4).
    const double bend =
        r.acceleration + r.stiffness * (r.knee - knee) + r.damping * (r.rate - rate);
    out.privileged_acceleration[leg.knee] = leg.knee_bend_sign * bend;
    out.privileged_acceleration[leg.hip_pitch] = 0.5 * leg.hip_pitch_bend_sign * bend;
    out.privileged_acceleration[leg.ankle_pitch] = 0.5 * leg.ankle_pitch_bend_sign * bend;
    // A leg counts as one that stands by as much as it carries.
    const double swings = LegConfiguration::kBentGains.weight;
    const bool touches = gait.footholds[side].contact != GAITD_CONTACT_NONE;
    const double share = touches ? load_share(side, gait) : 0.0;
    const double weight = r.weight > swings ? swings + share * (r.weight - swings) : r.weight;
    for (int joint : {leg.knee, leg.hip_pitch, leg.ankle_pitch}) {
      out.privileged_weight[joint] = weight;
    }
  }
}

}  // namespace gaitd::walking
