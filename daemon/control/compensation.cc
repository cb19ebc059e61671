// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/compensation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gaitd/sdk/sensors.h"
#include "gaitd/sdk/views.h"

namespace gaitd::daemon {
namespace {

// Torque over stiffness, as the teams of Atlas had it, but as fast as the rotor swings on its
// spring: what a slower filter leaves out is taken for motion. The angle is bounded, so that one
// bad torque sensor does not move a joint (see docs/decisions/compensation.md).
constexpr double kTorqueBandwidth = 100.0;  // Hz
constexpr double kLargestBend = 0.1;        // rad
// In which friction turns round with the rate that the link is to have. The Stribeck speed of real
// joints is 0.02 to 0.15 rad/s; a step there would make the drive chatter while it stands.
constexpr double kTurnRate = 0.08;  // rad/s
// Hz, up to which friction is made up for on two feet. Faster, it is all that damps a robot whose
// legs move while it stands: Atlas shook at 18 Hz (see docs/decisions/compensation.md).
constexpr double kStandingBandwidth = 5.0;

// Share of a step that a low-pass of the first order follows in `dt` seconds.
double low_pass(double hertz, double dt) {
  return -std::expm1(-2.0 * std::numbers::pi * hertz * dt);
}

}  // namespace

Compensation::Compensation(const GaitdModel& model, const Calibration& calibration)
    : model_(model), calibration_(calibration) {
  for (int i = 0; i < model.joint_count; ++i) {
    const JointCalibration& joint = calibration.joints[i];
    used_ = used_ || joint.zero != 0.0 || joint.stiffness > 0.0 || joint.torque_bias != 0.0 ||
            joint.coulomb > 0.0 || joint.viscous > 0.0;
  }
  for (const GaitdFoot& foot : model.feet) {
    feet_sensed_ = feet_sensed_ && sdk::has_force_sensor(foot);
  }
  for (const FootCalibration& foot : calibration.feet) {
    used_ = used_ || foot.mass > 0.0 || foot.force != std::array<double, 3>{} ||
            foot.moment != std::array<double, 3>{};
  }
}

// rad, of the encoder against the link.
double Compensation::bend(int joint, double torque) const {
  const double stiffness = calibration_.joints[joint].stiffness;
  if (stiffness <= 0.0) return 0.0;
  return std::clamp(torque / stiffness, -kLargestBend, kLargestBend);
}

// N m, of a joint that turns at `rate` (rad/s).
double Compensation::friction(int joint, double rate) const {
  const JointCalibration& own = calibration_.joints[joint];
  return own.coulomb * std::tanh(rate / kTurnRate) + own.viscous * rate;
}

// N m, that do not arrive at a link that is to turn at `rate` (rad/s).
double Compensation::lost(int joint, double rate) const {
  return friction(joint, rate) - calibration_.joints[joint].torque_bias;
}

void Compensation::joint(double gain, double dt, int index, GaitdJointSensor& sensor) {
  const JointCalibration& own = calibration_.joints[index];
  sensor.torque += own.torque_bias;
  const double before = bend(index, torque_[index]);
  torque_[index] += (known_ ? gain : 1.0) * (sensor.torque - torque_[index]);
  const double now = bend(index, torque_[index]);
  sensor.position -= own.zero + now;
  if (known_) sensor.velocity -= (now - before) / dt;
  // Where the load on the feet comes from the torques of the joints, those are to arrive there.
  if (!feet_sensed_) sensor.torque -= friction(index, sensor.velocity);
}

void Compensation::foot(int side, const GaitdRobotState& robot,
                        GaitdFootForceSensor& sensor) const {
  const FootCalibration& own = calibration_.feet[side];
  const GaitdFoot& foot = model_.feet[side];
  // Level until the estimator knows more: a robot that stands, or hangs with its legs down.
  Eigen::Quaterniond body = Eigen::Quaterniond::Identity();
  if (robot.valid != 0) {
    body = sdk::quaternion(robot.feet[side].orientation) *
           sdk::quaternion(foot.sole.orientation).conjugate();
  }
  const Eigen::Quaterniond turn = sdk::quaternion(foot.force_sensor.orientation).conjugate();
  const Eigen::Vector3d weight_body =
      body.conjugate() * Eigen::Vector3d(0, 0, -own.mass * model_.gravity);
  const Eigen::Vector3d arm = Eigen::Vector3d(own.com.data()) - sdk::view(foot.force_sensor.origin);
  sdk::view(sensor.force) -= turn * weight_body + Eigen::Vector3d(own.force.data());
  sdk::view(sensor.moment) -= turn * arm.cross(weight_body) + Eigen::Vector3d(own.moment.data());
}

void Compensation::sensors(double dt, TickData& d) {
  if (!used_) return;
  const double gain = low_pass(kTorqueBandwidth, dt);
  for (int i = 0; i < model_.joint_count; ++i) joint(gain, dt, i, d.sensors.joints[i]);
  for (int side = 0; side < GAITD_MAX_FEET; ++side) foot(side, d.robot, d.sensors.feet[side]);
  known_ = true;
}

void Compensation::commands(double dt, TickData& d, double torque_ratio) {
  if (!used_) return;
  const double share = d.gait.phase == GAITD_PHASE_STAND ? low_pass(kStandingBandwidth, dt) : 1.0;
  for (int i = 0; i < model_.joint_count; ++i) {
    GaitdJointCommand& command = d.commands.joints[i];
    command.position += calibration_.joints[i].zero + bend(i, command.torque);
    if (command.mode != GAITD_JOINT_MODE_TORQUE) {
      rate_[i] = 0.0;
      continue;
    }
    const double limit = torque_ratio * model_.joints[i].effort_limit;
    rate_[i] += share * (command.velocity - rate_[i]);
    command.torque = std::clamp(command.torque + lost(i, rate_[i]), -limit, limit);
  }
}

}  // namespace gaitd::daemon
