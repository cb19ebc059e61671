// SPDX-License-Identifier: Apache-2.0
// The part of Safety that switches a robot on and off, and the test of one joint.
#include <cmath>

#include "daemon/control/safety.h"

namespace gaitd::daemon {

using P = SafetyParameter;

Circumstances Safety::circumstances(const TickData& d, bool estimated) const {
  return {model_, p_, balance_, d, state_, estimated};
}

const char* Safety::refusal(Request request, const TickData& d) const {
  return refusal_of(request, circumstances(d, d.robot.valid != 0));
}

// Of a request that the state alone decides about.
const char* Safety::refusal(Request request) const {
  static const TickData kNoReadings{};
  return refusal_of(request, circumstances(kNoReadings, false));
}

const char* Safety::arm() {
  if (const char* why = refusal(kRequestStart)) return why;
  if (state_ != SafetyState::kDisarmed) return nullptr;
  state_ = SafetyState::kReadying;
  time_in_state_ = 0.0;
  time_settled_ = 0.0;
  time_hanging_ = 0.0;
  time_unsolved_ = 0.0;
  start_taken_ = false;
  return nullptr;
}

const char* Safety::arm(const TickData& d) {
  if (controlled() || state_ == SafetyState::kReadying) return nullptr;
  const char* why = refusal(kRequestArm, d);
  return why != nullptr ? why : arm();
}

const char* Safety::disarm() {
  if (const char* why = refusal(kRequestDisarm)) return why;
  state_ = SafetyState::kDisarmed;
  return nullptr;
}

const char* Safety::test_joint(const TickData& d, const JointTest& test) {
  if (const char* why = refusal(kRequestJointTest, d)) return why;
  state_ = SafetyState::kTesting;
  time_in_state_ = 0.0;
  test_ = test;
  start_position_[test.joint] = d.sensors.joints[test.joint].position;
  return nullptr;
}

// There and back without a jerk; when the time is over the joint is off, too.
void Safety::swing_joint(GaitdJointCommands& commands) const {
  for (int i = 0; i < model_.joint_count; ++i) {
    commands.joints[i] = {};
    commands.joints[i].mode = GAITD_JOINT_MODE_OFF;
  }
  if (time_in_state_ > test_.duration) return;
  GaitdJointCommand& c = commands.joints[test_.joint];
  const double effort = model_.joints[test_.joint].effort_limit;
  const double phase = 2.0 * M_PI * time_in_state_ / test_.duration;
  c.mode = GAITD_JOINT_MODE_TORQUE;
  c.position = start_position_[test_.joint] + 0.5 * test_.amplitude * (1.0 - std::cos(phase));
  c.velocity = test_.amplitude * M_PI / test_.duration * std::sin(phase);
  c.stiffness = p_[P::kReadyStiffness] * effort;
  c.damping = kReadyDamping * p_[P::kReadyStiffness] * effort;
}

}  // namespace gaitd::daemon
