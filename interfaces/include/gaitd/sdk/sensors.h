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

}  // namespace gaitd::sdk
