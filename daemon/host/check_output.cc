// SPDX-License-Identifier: Apache-2.0
#include "daemon/host/check_output.h"

#include <cmath>

namespace gaitd::daemon {
namespace {

constexpr const char* kWrongSize = "size: is not that of the struct of this ABI";

bool finite(const double* values, int count) {
  // A sum is not finite as soon as one term is not; far cheaper than asking each.
  double sum = 0.0;
  for (int i = 0; i < count; ++i) sum += values[i] - values[i];
  return sum == 0.0;
}
template <int N>
bool finite(const double (&values)[N]) {
  return finite(values, N);
}

bool unit(const double (&quaternion)[4]) {
  double norm = 0.0;
  for (const double x : quaternion) norm += x * x;
  return std::abs(norm - 1.0) < 1e-3;  // false for NaN as well
}

bool is_foot(int side) { return side == GAITD_LEFT || side == GAITD_RIGHT; }

const char* foot_error(const GaitdFootState& foot) {
  if (foot.contact != GAITD_CONTACT_NONE && foot.contact != GAITD_CONTACT_TOE &&
      foot.contact != GAITD_CONTACT_FULL) {
    return "feet.contact: is none of GAITD_CONTACT_*";
  }
  if (!finite(foot.position)) return "feet.position: is not finite";
  if (!unit(foot.orientation)) return "feet.orientation: is no unit quaternion";
  if (!finite(foot.twist)) return "feet.twist: is not finite";
  if (!finite(foot.wrench)) return "feet.wrench: is not finite";
  if (!std::isfinite(foot.normal_force)) return "feet.normal_force: is not finite";
  if (!finite(foot.cop) || !finite(foot.cop_world)) return "feet.cop: is not finite";
  return nullptr;
}

const char* command_error(const GaitdJointCommand& c) {
  if (c.mode != GAITD_JOINT_MODE_OFF && c.mode != GAITD_JOINT_MODE_DAMPING &&
      c.mode != GAITD_JOINT_MODE_TORQUE) {
    return "commands.joints.mode: is none of GAITD_JOINT_MODE_*";
  }
  if (!std::isfinite(c.torque)) return "commands.joints.torque: is not finite";
  if (!std::isfinite(c.position + c.velocity + c.acceleration)) {
    return "commands.joints: position, velocity or acceleration is not finite";
  }
  if (!std::isfinite(c.stiffness + c.damping) || c.stiffness < 0.0 || c.damping < 0.0) {
    return "commands.joints: stiffness or damping is negative or not finite";
  }
  return nullptr;
}

}  // namespace

const char* output_error(const GaitdRobotState& r, int joint_count) {
  if (r.size != sizeof(r)) return kWrongSize;
  if (r.valid == 0) return "valid: is 0, there is no estimate";
  if (r.joint_count != joint_count) return "joint_count: is not that of the model";
  if (!finite(r.pelvis_position)) return "pelvis_position: is not finite";
  if (!unit(r.pelvis_orientation)) return "pelvis_orientation: is no unit quaternion";
  if (!finite(r.pelvis_twist)) return "pelvis_twist: is not finite";
  if (!finite(r.joint_position, joint_count)) return "joint_position: is not finite";
  if (!finite(r.joint_velocity, joint_count)) return "joint_velocity: is not finite";
  if (!finite(r.com)) return "com: is not finite";
  if (!finite(r.com_velocity)) return "com_velocity: is not finite";
  if (!finite(r.icp)) return "icp: is not finite";
  if (!finite(r.cop)) return "cop: is not finite";
  if (!finite(r.pelvis_velocity_covariance)) return "pelvis_velocity_covariance: is not finite";
  if (!finite(r.external_wrench)) return "external_wrench: is not finite";
  for (const GaitdFootState& foot : r.feet) {
    if (const char* error = foot_error(foot)) return error;
  }
  return nullptr;
}

const char* output_error(const GaitdIcpPlan& p, int) {
  if (p.size != sizeof(p)) return kWrongSize;
  if (!finite(p.icp)) return "icp: is not finite";
  if (!finite(p.icp_velocity)) return "icp_velocity: is not finite";
  if (!finite(p.ecmp)) return "ecmp: is not finite";
  if (!finite(p.icp_end)) return "icp_end: is not finite";
  if (!finite(p.icp_touchdown)) return "icp_touchdown: is not finite";
  if (!finite(p.icp_transferred)) return "icp_transferred: is not finite";
  if (!std::isfinite(p.kappa) || p.kappa < 0.0) return "kappa: is negative or not finite";
  if (!std::isfinite(p.time_remaining)) return "time_remaining: is not finite";
  if (!finite(p.offset)) return "offset: is not finite";
  if (!finite(p.gamma)) return "gamma: is not finite";
  return nullptr;
}

const char* output_error(const GaitdStepAdjustment& a, int) {
  if (a.size != sizeof(a)) return kWrongSize;
  if (!finite(a.shift)) return "shift: is not finite";
  if (!std::isfinite(a.time_shift)) return "time_shift: is not finite";
  if (!finite(a.ecmp)) return "ecmp: is not finite";
  if (!finite(a.cmp)) return "cmp: is not finite";
  if (!std::isfinite(a.kappa)) return "kappa: is not finite";
  if (!finite(a.linear_momentum_rate)) return "linear_momentum_rate: is not finite";
  if (!finite(a.angular_momentum_rate)) return "angular_momentum_rate: is not finite";
  if ((a.angular_momentum_mask & ~0b111) != 0) return "angular_momentum_mask: has rows beyond 2";
  return nullptr;
}

const char* output_error(const GaitdToeOff& t, int) {
  if (t.size != sizeof(t)) return kWrongSize;
  if (t.active != 0 && !is_foot(t.side)) return "side: is no foot, with toe-off active";
  if (!finite(t.toe_point)) return "toe_point: is not finite";
  if (!finite(t.criterion)) return "criterion: is not finite";
  return nullptr;
}

const char* output_error(const GaitdWholeBodyControllerOutput& w, int joint_count) {
  if (w.size != sizeof(w)) return kWrongSize;
  switch (w.info.status) {
    case GAITD_WBC_SOLVED:
      break;
    case GAITD_WBC_MAX_ITERATIONS:
      return "info.status: the problem is not solved, iterations at their limit";
    case GAITD_WBC_INFEASIBLE:
      return "info.status: the problem is infeasible";
    case GAITD_WBC_NON_FINITE:
      return "info.status: the problem or its solution is not finite";
    default:
      return "info.status: is none of GAITD_WBC_*";
  }
  for (const auto& force : w.info.hand_force) {
    if (!finite(force)) return "info.hand_force: is not finite";
  }
  if (w.commands.joint_count != joint_count) {
    return "commands.joint_count: is not that of the model";
  }
  for (int i = 0; i < joint_count; ++i) {
    if (const char* error = command_error(w.commands.joints[i])) return error;
  }
  return nullptr;
}

const char* output_error(const GaitdTaskReferences& r, int joint_count) {
  if (r.size != sizeof(r)) return kWrongSize;
  if (!finite(r.com_shift)) return "com_shift: is not finite";
  if (!finite(r.com_shift_velocity) || !finite(r.com_shift_acceleration)) {
    return "com_shift: velocity or acceleration is not finite";
  }
  if (!unit(r.pelvis_turn)) return "pelvis_turn: is no unit quaternion";
  if (!finite(r.pelvis_turn_rate)) return "pelvis_turn_rate: is not finite";
  if (!unit(r.chest_turn)) return "chest_turn: is no unit quaternion";
  if (!finite(r.chest_turn_rate)) return "chest_turn_rate: is not finite";
  if (!finite(r.joint_position, joint_count)) return "joint_position: is not finite";
  if (!finite(r.joint_velocity, joint_count)) return "joint_velocity: is not finite";
  if (!finite(r.joint_acceleration, joint_count)) return "joint_acceleration: is not finite";
  for (const GaitdHandReference& hand : r.hands) {
    if (!finite(hand.goal.position)) return "hands.goal: is not finite";
    if (!unit(hand.goal.orientation)) return "hands.goal: has no unit quaternion";
    if (!std::isfinite(hand.position_error + hand.turn_error) || !finite(hand.reach_error)) {
      return "hands: an error is not finite";
    }
  }
  return nullptr;
}

}  // namespace gaitd::daemon
