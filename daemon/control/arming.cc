// SPDX-License-Identifier: Apache-2.0
// The part of Safety that decides whether a robot may be switched on, and the test of one joint.
#include <cmath>

#include "daemon/control/safety.h"

namespace gaitd::daemon {

using P = SafetyParameter;

bool Safety::sensors_fresh(const TickData& d) const {
  for (int i = 0; i < d.sensors.joint_count; ++i) {
    if (stale(d.sensors.joints[i].info)) return false;
  }
  for (int i = 0; i < d.sensors.foot_count; ++i) {
    if (stale(d.sensors.feet[i].info)) return false;
  }
  for (int i = 0; i < d.sensors.imu_count; ++i) {
    if (!stale(d.sensors.imus[i].info)) return true;
  }
  return false;  // no IMU
}

// Null, or why nothing may be switched on.
const char* Safety::unfit(const TickData& d) const {
  if ((d.health & GAITD_HEALTH_ESTOP) != 0) {
    return "not armed: the e-stop is pressed; release it";
  }
  if ((d.health & GAITD_HEALTH_HEARTBEAT) != 0) {
    return "not armed: the e-stop is silent; check that it is on and connected";
  }
  if (d.health != 0) {
    return "not armed: a motor or a bus is not healthy; `gaitctl status` says which";
  }
  if (!sensors_fresh(d)) {
    return "not armed: a joint, every IMU or a foot sensor is silent; check power and wiring";
  }
  constexpr double kBeyond = 0.05;  // rad that a stop may give way
  for (int i = 0; i < model_.joint_count; ++i) {
    const GaitdJoint& joint = model_.joints[i];
    const double position = d.sensors.joints[i].position;
    if (position < joint.position_min - kBeyond || position > joint.position_max + kBeyond) {
      return "not armed: a joint is outside the limits of the model; check sign and offset with "
             "`gaitctl joint list`";
    }
  }
  return nullptr;
}

const char* Safety::arm(const TickData& d) {
  if (state_ == SafetyState::kTesting) return "a joint test is running; wait until it is over";
  const char* why = state_ == SafetyState::kDisarmed ? unfit(d) : nullptr;
  return why != nullptr ? why : arm();
}

const char* Safety::test_joint(const TickData& d, const JointTest& test) {
  if (state_ != SafetyState::kDisarmed) {
    return "joint test: expected a disarmed robot on its hoist; `gaitctl disarm` first";
  }
  if (const char* why = unfit(d)) return why;
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
  c.damping = p_[P::kReadyDamping] * effort;
}

}  // namespace gaitd::daemon
