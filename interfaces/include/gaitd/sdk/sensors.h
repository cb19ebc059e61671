// SPDX-License-Identifier: Apache-2.0
// Which sensor values may be computed with.
#pragma once

#include <cmath>

#include "gaitd/abi/types.h"
#include "gaitd/sdk/views.h"

namespace gaitd::sdk {

// A number that is none must not get into a state, whatever the sensor says of itself.
inline bool usable(const GaitdJointSensor& joint) {
  return joint.info.valid != 0 && std::isfinite(joint.position) && std::isfinite(joint.velocity);
}
inline bool usable(const GaitdImuSensor& imu) {
  return imu.info.valid != 0 && view(imu.angular_rate).allFinite() &&
         view(imu.specific_force).allFinite();
}
inline bool usable(const GaitdFootForceSensor& foot) {
  return foot.info.valid != 0 && view(foot.force).allFinite() && view(foot.moment).allFinite();
}

inline bool has_force_sensor(const GaitdFoot& foot) { return foot.force_sensor.body >= 0; }

// The first IMU of the model that is usable, or -1.
inline int first_usable_imu(const GaitdModel& model, const GaitdSensors& sensors) {
  for (int i = 0; i < sensors.imu_count && i < model.imu_count; ++i) {
    if (usable(sensors.imus[i])) return i;
  }
  return -1;
}

// Wrench of the ground on the foot about the sole origin, sole axes, moment first; both frames are
// fixed to the foot. Zero where the sensor is not usable.
inline Vector6d sole_wrench(const GaitdFoot& foot, const GaitdFootForceSensor& sensor) {
  Vector6d wrench = Vector6d::Zero();
  if (!usable(sensor)) return wrench;
  const Eigen::Quaterniond sole = quaternion(foot.sole.orientation);
  const Eigen::Quaterniond turn = sole.conjugate() * quaternion(foot.force_sensor.orientation);
  const Eigen::Vector3d lever =
      sole.conjugate() * (view(foot.force_sensor.origin) - view(foot.sole.origin));
  const Eigen::Vector3d force = turn * view(sensor.force);
  wrench << turn * view(sensor.moment) + lever.cross(force), force;
  return wrench;
}

/// s. A robot that nothing has carried for longer hangs on its hoist: it stays about where it is,
/// which an estimator can hold on to.
inline constexpr double kLongestFlight = 0.5;

/// Does the specific force of an IMU (m/s^2) show where up is? A robot that falls, or is just being
/// set down, shows something else: it has to be that of gravity, and the feet have to carry the
/// robot, or it must have lasted, as on a hoist. Feet without sensors are taken to carry it.
class Gravity {
 public:
  void reset() { lasted_ = 0.0; }
  /// Once in a tick of `period` seconds.
  bool shows(const GaitdModel& model, const GaitdSensors& sensors,
             const Eigen::Vector3d& specific_force, double period) {
    const double error = specific_force.norm() - model.gravity;
    lasted_ = std::abs(error) < kShare * model.gravity ? lasted_ + period : 0.0;
    double load = sensors.foot_count > 0 ? 0.0 : model.total_mass * model.gravity;
    for (int side = 0; side < sensors.foot_count; ++side) {
      const GaitdFootForceSensor& foot = sensors.feet[side];
      if (usable(foot)) load += view(foot.force).norm();
    }
    const bool carried = load > 0.5 * model.total_mass * model.gravity;
    return lasted_ > 0.0 && (carried || lasted_ > kHanging);
  }

 private:
  static constexpr double kShare = 0.1;    // of gravity
  static constexpr double kHanging = 0.1;  // s
  double lasted_ = 0.0;
};

}  // namespace gaitd::sdk
