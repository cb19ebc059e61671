// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/handholds.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"

namespace gaitd::walking {
namespace {

using sdk::view;

constexpr double kPress = 0.015;    // weights
constexpr double kRamp = 0.2;       // s, in which a force comes or goes
constexpr double kDrawTime = 0.3;   // s, of the way back from a surface
constexpr double kForget = 0.5;     // s: a hand that creeps along its surface is not torn off
constexpr double kProof = 0.4;      // s, for which it only presses, once it is stopped
constexpr double kStopTime = 0.15;  // s, for which it is
// Heights of the CoM.
constexpr double kSeekSpeed = 0.05;   // 1/s, of the place that a hand that seeks follows
constexpr double kBehind = 0.02;      // that it is behind it by, once something stops it
constexpr double kFarthest = 0.09;    // that it seeks
constexpr double kDrawBack = 0.1;     // that it goes back from the surface, letting go
constexpr double kHandLost = 0.05;    // that a hand may be off its place
constexpr double kStopped = 0.8;      // of kBehind: a hand that nothing stops keeps up better
constexpr double kArmLever = 0.05;    // heights of the CoM, that an arm needs to press with
constexpr double kAtStop = 0.03;      // rad, of a joint that goes no further
constexpr double kEffortShare = 0.7;  // of the joints of an arm; the rest is for its weight

// Across the normal, any.
Eigen::Vector3d tangent_of(const Eigen::Vector3d& normal) {
  const bool level = std::abs(normal.z()) < 0.7;
  const Eigen::Vector3d other = level ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
  return (other - other.dot(normal) * normal).normalized();
}

}  // namespace

GaitdContactPoint hand_contact(const GaitdModel& model, int hand, const GaitdHandhold& handhold) {
  const GaitdFrame& frame = model.hands[hand];
  GaitdContactPoint contact{};
  contact.side = GAITD_BOTH;
  contact.body = frame.body;
  view(contact.point) = view(frame.origin);
  const Eigen::Vector3d normal = view(handhold.normal);
  view(contact.normal) = normal;
  view(contact.tangent) = tangent_of(normal);
  contact.friction = handhold.friction;
  // The edges share the force: each of unit length, a little longer than its part of the normal.
  const double share = 0.25 * std::sqrt(1.0 + handhold.friction * handhold.friction);
  contact.rho_min = share * handhold.force_min;
  contact.rho_max = share * handhold.force_max;
  return contact;
}

Handholds::Handholds(const GaitdModel& model)
    : model_(model),
      press_(kPress * model.total_mass * model.gravity),
      kinematics_(model),
      arms_{JointChain::arm(model, GAITD_LEFT), JointChain::arm(model, GAITD_RIGHT)} {}

void Handholds::reset() { hands_ = {}; }

double Handholds::lever(int side, const Eigen::Vector3d& normal,
                        const GaitdRobotState& robot) const {
  const JointChain& arm = arms_[side];
  const JointChain::Joints q = arm.of(robot.joint_position);
  const JointChain::Jacobian columns = arm.jacobian(q);
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
  for (int i = 0; i < arm.size(); ++i) {
    if (std::min(q[i] - arm.least(i), arm.most(i) - q[i]) < kAtStop) continue;
    square += columns.col(i).tail<3>() * columns.col(i).tail<3>().transpose();
  }
  const Eigen::Vector3d in_chest = kinematics_.R_WB(model_.chest_body).transpose() * normal;
  return std::sqrt(in_chest.dot(square * in_chest));
}

double Handholds::bearable(int side, const Eigen::Vector3d& normal,
                           const GaitdRobotState& robot) const {
  const JointChain& arm = arms_[side];
  const JointChain::Jacobian columns = arm.jacobian(arm.of(robot.joint_position));
  const Eigen::Vector3d in_chest = kinematics_.R_WB(model_.chest_body).transpose() * normal;
  double most = INFINITY;
  for (int i = 0; i < arm.size(); ++i) {
    const double effort = kEffortShare * model_.joints[arm.joint(i)].effort_limit;
    const double arm_of_force = std::abs(columns.col(i).tail<3>().dot(in_chest));
    if (arm_of_force > 0.0) most = std::min(most, effort / arm_of_force);
  }
  return most;
}

Refusal Handholds::take(const HandholdCommand& command, const GaitdRobotState& robot) {
  const int side = command.hand;
  const char* name = side_name(side);
  if (arms_[side].size() == 0) {
    return refuse(
        "handhold.take: the robot has no %s hand; say where it is under `hands:` in "
        "robot.yaml",
        name);
  }
  if (busy(side)) {
    return refuse(
        "handhold.take: the %s hand holds on already; `gaitctl handhold release %s`, then again",
        name, name);
  }
  int points = GAITD_MAX_HANDS;
  for (const GaitdFoot& foot : model_.feet) points += foot.point_count;
  if (points > GAITD_MAX_CONTACTS) {
    return refuse(
        "handhold.take: expected at most %d corners of both soles beside two hands, got %d; give "
        "the soles fewer corners in robot.yaml",
        GAITD_MAX_CONTACTS - GAITD_MAX_HANDS, points - GAITD_MAX_HANDS);
  }
  const Eigen::Quaterniond heading =
      sdk::from_yaw(sdk::yaw_of(sdk::quaternion(robot.pelvis_orientation)));
  const Eigen::Vector3d normal = heading * Eigen::Vector3d(view(command.normal)).normalized();
  kinematics_.update(robot);
  const GaitdFrame& frame = model_.hands[side];
  const Eigen::Vector3d position = kinematics_.frame_position(frame.body, view(frame.origin));
  if (lever(side, normal, robot) < kArmLever * model_.nominal_com_height) {
    return refuse(
        "handhold.take: the %s arm is stretched, it could not press; bring the hand nearer "
        "to the body: `gaitctl pose hand`",
        name);
  }
  const double most = bearable(side, normal, robot);
  const double least = 2.0 * press_;
  if (command.force < least || most < least) {
    return refuse(
        "handhold.take: force: expected at least %.0f N, twice what a hand of this robot presses "
        "with, got %.0f N, of which the arm bears %.0f N in this posture",
        least, command.force, std::min(command.force, most));
  }
  Hand& hand = hands_[side];
  hand = {};
  hand.state = GAITD_HANDHOLD_SOUGHT;
  hand.anchor = hand.start = position;
  hand.normal = normal;
  hand.friction = command.friction;
  hand.allowed = allowed_ = std::min(command.force, most);
  return {};
}

Refusal Handholds::release(int hand) {
  bool any = false;
  for (int side = 0; side < GAITD_MAX_HANDS; ++side) {
    if ((hand != GAITD_BOTH && hand != side) || !busy(side)) continue;
    any = true;
    begin_to_let_go(hands_[side]);
  }
  if (any) return {};
  if (hand == GAITD_BOTH) return refuse("handhold.release: no hand holds on to anything");
  return refuse("handhold.release: the %s hand holds on to nothing", side_name(hand));
}

void Handholds::begin_to_let_go(Hand& hand) {
  if (hand.state == GAITD_HANDHOLD_LET_GO) return;
  hand.state = GAITD_HANDHOLD_LET_GO;
  hand.time = 0.0;
}

void Handholds::seek(double dt, const Eigen::Vector3d& position, Hand& hand) const {
  const double height = model_.nominal_com_height;
  if ((position - hand.start).norm() > kFarthest * height) {
    hand.change = Change::kNothing;
    return;
  }
  const double behind = hand.normal.dot(position - hand.anchor);
  if (behind < kBehind * height) hand.anchor -= kSeekSpeed * height * dt * hand.normal;
  hand.time = behind > kStopped * kBehind * height ? hand.time + dt : 0.0;
  if (hand.time < kStopTime) return;
  hand.state = GAITD_HANDHOLD_HELD;
  hand.anchor = position;
  hand.time = 0.0;
  hand.least = hand.most = press_;
  hand.change = Change::kHeld;
}

void Handholds::hold(double dt, const Eigen::Vector3d& position, Hand& hand) const {
  hand.time += dt;
  if (hand.time > kProof) {
    hand.most = std::min(hand.allowed, hand.most + hand.allowed * dt / kRamp);
  }
  const Eigen::Vector3d moved = position - hand.anchor;
  const Eigen::Vector3d across = moved - moved.dot(hand.normal) * hand.normal;
  hand.anchor += std::min(1.0, dt / kForget) * across;
  if (moved.norm() > kHandLost * model_.nominal_com_height) {
    hand.change = hand.time > kProof ? Change::kLost : Change::kNothing;
    hand.least = hand.most = 0.0;
  }
}

void Handholds::let_go(double dt, const Eigen::Vector3d& position, Hand& hand) const {
  if (hand.most > 0.0) {
    hand.least = std::max(0.0, hand.least - press_ * dt / kRamp);
    hand.most -= hand.allowed * dt / kRamp;
    if (hand.most > hand.least) return;
    hand.least = hand.most = 0.0;
    hand.anchor = position;
  }
  // Off the surface, which a robot that sways would lean on.
  hand.anchor += kDrawBack * model_.nominal_com_height * dt / kDrawTime * hand.normal;
  hand.time += dt;
  if (hand.time < kDrawTime) return;
  hand.state = GAITD_HANDHOLD_NONE;
  if (!hand.told) hand.change = Change::kReleased;
}

bool Handholds::fails(int hand, std::uint64_t failed) const {
  const JointChain& arm = arms_[hand];
  for (int i = 0; i < arm.size(); ++i) {
    if ((failed >> arm.joint(i) & 1u) != 0) return true;
  }
  return false;
}

void Handholds::update(double dt, bool controlled, const GaitdGaitState& gait,
                       const GaitdWbcInfo& last, GaitdRobotState& robot, std::uint64_t failed) {
  for (GaitdHandhold& handhold : robot.handholds) handhold = {};
  if (!controlled) reset();
  if (!busy()) {
    for (Hand& hand : hands_) hand.change = Change::kNone;
    return;
  }
  kinematics_.update(robot);
  for (int side = 0; side < GAITD_MAX_HANDS; ++side) {
    Hand& hand = hands_[side];
    hand.change = Change::kNone;
    if (!busy(side)) continue;
    const GaitdFrame& frame = model_.hands[side];
    const Eigen::Vector3d position = kinematics_.frame_position(frame.body, view(frame.origin));
    if (hand.state == GAITD_HANDHOLD_LET_GO) {
      let_go(dt, position, hand);
    } else if (gait.phase != GAITD_PHASE_STAND) {
      hand.change = Change::kSteps;
    } else if (fails(side, failed)) {
      hand.change = Change::kFailed;
      hand.least = hand.most = 0.0;
    } else if (hand.state == GAITD_HANDHOLD_SOUGHT) {
      seek(dt, position, hand);
    } else {
      hold(dt, position, hand);
    }
    hand.told = hand.told || hand.change >= Change::kNothing;
    if (hand.told && busy(side)) begin_to_let_go(hand);
    if (!busy(side)) continue;
    GaitdHandhold& out = robot.handholds[side];
    out.state = hand.state;
    view(out.position) = position;
    view(out.anchor) = hand.anchor;
    view(out.normal) = hand.normal;
    out.friction = hand.friction;
    out.force_min = hand.least;
    out.force_max = hand.most;
    view(out.force) = view(last.hand_force[side]);
  }
}

}  // namespace gaitd::walking
