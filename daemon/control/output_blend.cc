// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/output_blend.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "gaitd/sdk/views.h"

namespace gaitd::daemon {
namespace {

// What two sound variants may differ by: at least 2.5 times what the shipped ones do in the hundred
// swaps of the scenario `swaps` (in brackets), and not more than a robot survives.
constexpr double kPosition = 0.05;  // m, of the pelvis: a foothold missed by the edge of a stair
constexpr double kAngle = 0.1;      // rad, of the pelvis; all three of the estimators: (9 %)
constexpr double kVelocity = 0.5;   // m/s, of the CoM: 0.15 m of the ICP
constexpr double kIcpReference = 0.25;  // m, one length of a foot (0.04 m)
constexpr double kCmp = 0.4;     // m, from edge to edge of both feet when they stand together
constexpr double kShift = 0.05;  // m, of the CoM that a task source asks for
constexpr double kJoint = 1.0;   // rad, of a joint that it has a reference for: a swing of the arms
constexpr double kTorque = 1.5;  // effort limits, of one joint: nearly its range (0.6)

template <std::size_t kSize>
double distance(const double (&a)[kSize], const double (&b)[kSize]) {
  double sum = 0.0;
  for (std::size_t i = 0; i < kSize; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

double angle(const double (&a)[4], const double (&b)[4]) {
  double dot = 0.0;
  for (int i = 0; i < 4; ++i) dot += a[i] * b[i];
  return 2.0 * std::acos(std::min(1.0, std::abs(dot)));
}

void mix(double from, double share, double& to) { to = from + share * (to - from); }
template <std::size_t kSize>
void mix(const double (&from)[kSize], double share, double (&to)[kSize]) {
  for (std::size_t i = 0; i < kSize; ++i) mix(from[i], share, to[i]);
}
// Of unit quaternions: the short way.
void mix_turn(const double (&from)[4], double share, double (&to)[4]) {
  sdk::store(sdk::quaternion(from).slerp(share, sdk::quaternion(to)), to);
}

}  // namespace

double output_difference(const GaitdModel&, const GaitdRobotState& a, const GaitdRobotState& b) {
  return std::max({distance(a.pelvis_position, b.pelvis_position) / kPosition,
                   angle(a.pelvis_orientation, b.pelvis_orientation) / kAngle,
                   distance(a.com_velocity, b.com_velocity) / kVelocity});
}

double output_difference(const GaitdModel&, const GaitdIcpPlan& a, const GaitdIcpPlan& b) {
  return distance(a.icp, b.icp) / kIcpReference;
}

double output_difference(const GaitdModel&, const GaitdStepAdjustment& a,
                         const GaitdStepAdjustment& b) {
  return distance(a.cmp, b.cmp) / kCmp;
}

double output_difference(const GaitdModel&, const GaitdToeOff&, const GaitdToeOff&) {
  return 0.0;  // yes or no: either may be right
}

double output_difference(const GaitdModel& model, const GaitdWholeBodyControllerOutput& a,
                         const GaitdWholeBodyControllerOutput& b) {
  double largest = 0.0;
  for (int i = 0; i < model.joint_count; ++i) {
    const double torque = a.commands.joints[i].torque - b.commands.joints[i].torque;
    largest = std::max(largest, std::abs(torque) / model.joints[i].effort_limit);
  }
  return largest / kTorque;
}

double output_difference(const GaitdModel& model, const GaitdTaskReferences& a,
                         const GaitdTaskReferences& b) {
  double largest = 0.0;
  for (int i = 0; i < model.joint_count; ++i) {
    largest = std::max(largest, std::abs(a.joint_position[i] - b.joint_position[i]));
  }
  return std::max({largest / kJoint, distance(a.com_shift, b.com_shift) / kShift,
                   angle(a.pelvis_turn, b.pelvis_turn) / kAngle,
                   angle(a.chest_turn, b.chest_turn) / kAngle});
}

void cross_fade(const GaitdIcpPlan& from, double share, GaitdIcpPlan& to) {
  mix(from.icp, share, to.icp);
  mix(from.icp_velocity, share, to.icp_velocity);
  mix(from.ecmp, share, to.ecmp);
  mix(from.icp_end, share, to.icp_end);
  mix(from.icp_touchdown, share, to.icp_touchdown);
  mix(from.icp_transferred, share, to.icp_transferred);
  mix(from.kappa, share, to.kappa);
}

void cross_fade(const GaitdStepAdjustment& from, double share, GaitdStepAdjustment& to) {
  // What was decided of the step is in the state of the gait, from which the layer goes on.
  mix(from.ecmp, share, to.ecmp);
  mix(from.cmp, share, to.cmp);
  mix(from.kappa, share, to.kappa);
  mix(from.linear_momentum_rate, share, to.linear_momentum_rate);
  mix(from.angular_momentum_rate, share, to.angular_momentum_rate);
}

void cross_fade(const GaitdWholeBodyControllerOutput& from, double share,
                GaitdWholeBodyControllerOutput& to) {
  for (int i = 0; i < to.commands.joint_count; ++i) {
    const GaitdJointCommand& a = from.commands.joints[i];
    GaitdJointCommand& b = to.commands.joints[i];
    mix(a.torque, share, b.torque);
    mix(a.position, share, b.position);
    mix(a.velocity, share, b.velocity);
    mix(a.stiffness, share, b.stiffness);
    mix(a.damping, share, b.damping);
    mix(a.acceleration, share, b.acceleration);
  }
}

void cross_fade(const GaitdTaskReferences& from, double share, GaitdTaskReferences& to) {
  mix(from.com_shift, share, to.com_shift);
  mix(from.com_shift_velocity, share, to.com_shift_velocity);
  mix(from.com_shift_acceleration, share, to.com_shift_acceleration);
  mix_turn(from.pelvis_turn, share, to.pelvis_turn);
  mix(from.pelvis_turn_rate, share, to.pelvis_turn_rate);
  mix_turn(from.chest_turn, share, to.chest_turn);
  mix(from.chest_turn_rate, share, to.chest_turn_rate);
  mix(from.joint_position, share, to.joint_position);
  mix(from.joint_velocity, share, to.joint_velocity);
  mix(from.joint_acceleration, share, to.joint_acceleration);
}

}  // namespace gaitd::daemon
