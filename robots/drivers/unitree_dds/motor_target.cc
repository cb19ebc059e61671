// SPDX-License-Identifier: Apache-2.0
#include "motor_target.h"

#include <algorithm>
#include <cmath>

namespace gaitd::unitree {
namespace {

bool finite(const GaitdJointCommand& c) {
  return std::isfinite(c.torque) && std::isfinite(c.position) && std::isfinite(c.velocity) &&
         std::isfinite(c.stiffness) && std::isfinite(c.damping);
}

float clamped(double value, double low, double high) {
  return static_cast<float>(std::clamp(value, low, high));
}

}  // namespace

MotorTarget motor_target(const GaitdJointCommand& c, const GaitdJoint& joint,
                         const Settings& settings) {
  MotorTarget target{};
  if (c.mode == GAITD_JOINT_MODE_OFF) return target;
  target.drive = Drive::kDamp;
  target.damping = std::isfinite(c.damping) ? clamped(c.damping, 0, settings.max_damping)
                                            : static_cast<float>(settings.damping);
  if (c.mode != GAITD_JOINT_MODE_TORQUE || !finite(c)) return target;
  target.drive = Drive::kDrive;
  target.position = clamped(c.position, joint.position_min, joint.position_max);
  target.velocity = clamped(c.velocity, -joint.velocity_limit, joint.velocity_limit);
  target.torque = clamped(c.torque, -joint.effort_limit, joint.effort_limit);
  target.stiffness = clamped(c.stiffness, 0, settings.max_stiffness);
  return target;
}

}  // namespace gaitd::unitree
