// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/safety.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gaitd::daemon {

using P = SafetyParameter;

const char* Safety::clear() {
  if (state_ == SafetyState::kFault) {
    state_ = SafetyState::kDisarmed;
    faults_ = 0;
  }
  return nullptr;
}

void Safety::reset() {
  state_ = SafetyState::kDisarmed;
  faults_ = 0;
  time_unsolved_ = 0.0;
}

void Safety::raise(std::uint32_t fault) {
  if (state_ == SafetyState::kDisarmed && fault != kFaultEstop) return;
  faults_ |= fault;
  state_ = SafetyState::kFault;
}

void Safety::stopping() {
  if (state_ == SafetyState::kWalking) state_ = SafetyState::kStopping;
}

void Safety::going_on() {
  if (state_ == SafetyState::kStopping) state_ = SafetyState::kWalking;
}

void Safety::check(const TickData& d, bool estimate_ok) {
  if (!controlled() || !estimate_ok) capture_.reset();
  if (state_ == SafetyState::kDisarmed || state_ == SafetyState::kFault) return;
  Circumstances now = circumstances(d, estimate_ok);
  now.out_of_reach =
      controlled() && estimate_ok && capture_.lost(d.time.period, d.robot, d.gait, p_);
  for (const Condition& condition : conditions()) {
    if ((condition.ticks & state_bit(now.state)) != 0 && condition.holds(now)) {
      raise(condition.faults);
    }
  }
}

bool Safety::update(double dt, const TickData& d, bool walking) {
  if (state_ == SafetyState::kStanding && walking) state_ = SafetyState::kWalking;
  if ((state_ == SafetyState::kWalking || state_ == SafetyState::kStopping) && !walking) {
    state_ = SafetyState::kStanding;
  }
  if (state_ == SafetyState::kTesting) {
    time_in_state_ += dt;
    if (time_in_state_ > test_.duration + dt) state_ = SafetyState::kDisarmed;
  }
  if (state_ != SafetyState::kReadying) return false;

  if (!start_taken_) {
    start_taken_ = true;
    for (int i = 0; i < model_.joint_count; ++i) start_position_[i] = d.robot.joint_position[i];
  }
  time_in_state_ += dt;
  bool in_posture = true;
  for (int i = 0; i < model_.joint_count; ++i) {
    in_posture = in_posture && std::abs(d.robot.joint_position[i] - model_.nominal_position[i]) <
                                   p_[P::kReadyTolerance];
  }
  const double weight = model_.total_mass * model_.gravity;
  const double left = d.robot.feet[GAITD_LEFT].normal_force;
  const double right = d.robot.feet[GAITD_RIGHT].normal_force;
  const bool loaded =
      left + right > kReadyLoad * weight && std::min(left, right) > 0.25 * kReadyLoad * weight;
  time_settled_ = in_posture && loaded ? time_settled_ + dt : 0.0;
  if (time_settled_ >= kReadySettle) {
    state_ = SafetyState::kStanding;
    return true;
  }
  // On a hoist it waits until it is lowered, however long that takes.
  if (in_posture && left + right < kReadyLoad * weight) time_hanging_ += dt;
  if (time_in_state_ - time_hanging_ > 2.0 * p_[P::kReadyDuration] + kReadySettle) {
    raise(kFaultReadying);
  }
  return false;
}

// What joints that pitch count for at least, N m. Ankle, knee and hip in a row hold the weight
// above them like springs; where their stiffness by effort is too little for that the robot
// topples.
double Safety::holding_effort(int joint) const {
  for (const GaitdLeg& leg : model_.legs) {
    const std::array<int, 3> pitches = {leg.hip_pitch, leg.knee, leg.ankle_pitch};
    if (std::find(pitches.begin(), pitches.end(), joint) == pitches.end()) continue;
    const double least =
        kReadyEffort * model_.total_mass * model_.gravity * model_.nominal_com_height;
    double give = 0.0;
    for (const int i : pitches) give += least / model_.joints[i].effort_limit;
    return give > 3.0 ? least : 0.0;
  }
  return 0.0;
}

void Safety::hold(GaitdJointCommands& commands) const {
  const double s = std::min(1.0, time_in_state_ / p_[P::kReadyDuration]);
  const double smooth = s * s * (3.0 - 2.0 * s);
  for (int i = 0; i < model_.joint_count; ++i) {
    GaitdJointCommand& c = commands.joints[i];
    const double effort = std::max(model_.joints[i].effort_limit, holding_effort(i));
    c = {};
    c.mode = GAITD_JOINT_MODE_TORQUE;
    c.position = start_position_[i] + smooth * (model_.nominal_position[i] - start_position_[i]);
    c.stiffness = p_[P::kReadyStiffness] * effort;
    c.damping = kReadyDamping * p_[P::kReadyStiffness] * effort;
  }
}

void Safety::damp(int joint, GaitdJointCommands& commands) const {
  GaitdJointCommand& c = commands.joints[joint];
  c = {};
  c.mode = GAITD_JOINT_MODE_DAMPING;
  c.damping = p_[P::kFaultDamping] * model_.joints[joint].effort_limit;
}

void Safety::damp(GaitdJointCommands& commands) const {
  for (int i = 0; i < model_.joint_count; ++i) damp(i, commands);
}

void Safety::fall_back(double dt, TickData& d) {
  // Last good torques, fading into joint damping; then the safe stop.
  time_unsolved_ += dt;
  if (time_unsolved_ > kSolverPatience) {
    raise(kFaultSolver);
    damp(d.commands);
    return;
  }
  const double share = 1.0 - time_unsolved_ / kSolverPatience;
  for (int i = 0; i < model_.joint_count; ++i) {
    GaitdJointCommand& c = d.commands.joints[i];
    c = {};
    c.mode = GAITD_JOINT_MODE_TORQUE;
    c.torque = share * last_good_torque_[i];
    c.damping = (1.0 - share) * p_[P::kFaultDamping] * model_.joints[i].effort_limit;
  }
}

void Safety::write(double dt, bool control_ok, TickData& d) {
  d.commands.size = sizeof(d.commands);
  d.commands.joint_count = model_.joint_count;
  d.commands.tick = d.time.tick;
  switch (state_) {
    case SafetyState::kDisarmed:
    case SafetyState::kFault:
      damp(d.commands);
      break;
    case SafetyState::kReadying:
      hold(d.commands);
      break;
    case SafetyState::kTesting:
      swing_joint(d.commands);
      break;
    default:
      if (control_ok) {
        time_unsolved_ = 0.0;
        for (int i = 0; i < model_.joint_count; ++i) {
          d.commands.joints[i] = d.wbc.commands.joints[i];
          last_good_torque_[i] = d.wbc.commands.joints[i].torque;
        }
      } else {
        fall_back(dt, d);
      }
      break;
  }
  if (!controlled()) last_good_torque_ = last_torque_;
  for (int i = 0; i < model_.joint_count; ++i) {
    if ((d.dropped >> i & 1u) != 0) damp(i, d.commands);
  }
  clamp(dt, d, d.commands);
  d.safety = state_;
  d.faults = faults_;
}

void Safety::clamp(double dt, const TickData& d, GaitdJointCommands& commands) {
  for (int i = 0; i < model_.joint_count; ++i) {
    GaitdJointCommand& c = commands.joints[i];
    const GaitdJoint& joint = model_.joints[i];
    const double limit = limits_[Limit::kTorqueRatio] * joint.effort_limit;
    const double rate = d.robot.joint_velocity[i];
    const double fastest = limits_[Limit::kVelocityRatio] * joint.velocity_limit;
    // Of a joint that has less room than two margins the middle is left.
    const double margin =
        std::min(limits_[Limit::kPositionMargin], 0.5 * (joint.position_max - joint.position_min));
    c.position = std::clamp(c.position, joint.position_min + margin, joint.position_max - margin);
    c.velocity = std::clamp(c.velocity, -fastest, fastest);
    double torque = std::clamp(c.torque, -limit, limit);
    if (controlled()) {
      const double step = p_[P::kTorqueRate] * joint.effort_limit * dt;
      torque = std::clamp(torque, last_torque_[i] - step, last_torque_[i] + step);
    }
    if (rate > fastest) torque = std::min(torque, 0.0);
    if (rate < -fastest) torque = std::max(torque, 0.0);
    // What the drive adds around its reference counts as well, and is softer where that is too
    // much: a torque against it would be more than the drive does if its gains are bounded, too.
    if (limits_[Limit::kTorqueRatio] < 1.0 && c.mode == GAITD_JOINT_MODE_TORQUE) {
      const double feedback =
          c.stiffness * (c.position - d.robot.joint_position[i]) + c.damping * (c.velocity - rate);
      const double room = std::max(0.0, limit - std::copysign(1.0, feedback) * torque);
      if (std::abs(feedback) > room) {
        c.stiffness *= room / std::abs(feedback);
        c.damping *= room / std::abs(feedback);
      }
    }
    c.torque = torque;
    // While readying the drives make the torque: what they make now is where control takes over.
    last_torque_[i] = state_ == SafetyState::kReadying
                          ? std::clamp(d.sensors.joints[i].torque, -limit, limit)
                          : torque;
  }
}

}  // namespace gaitd::daemon
