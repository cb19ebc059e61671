// SPDX-License-Identifier: Apache-2.0
// Where an IMU sits and how it moves against the pelvis: most humanoids carry theirs in the torso,
// behind the joints of the waist.
#pragma once

#include <cstddef>

#include "gaitd/abi/types.h"
#include "gaitd/sdk/views.h"

namespace gaitd::sdk {

struct ImuPlace {
  bool fixed = true;  // no joint lies between it and the pelvis
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // IMU axes in pelvis axes
  Eigen::Vector3d position = Eigen::Vector3d::Zero();               // m, from the pelvis origin
  // Against the pelvis, in its axes; zero where no joint lies between.
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();      // rad/s
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // m/s, of `position`
};

/// Of IMU `imu` of the model, for joint positions `q` (n, rad) and rates `qd` (n, rad/s).
/// Allocates nothing.
inline ImuPlace imu_place(const GaitdModel& model, int imu, const double* q, const double* qd) {
  const GaitdFrame& frame = model.imus[imu];
  ImuPlace place;
  if (frame.body <= 0) {  // fixed to the pelvis
    place.orientation = quaternion(frame.orientation);
    place.position = view(frame.origin);
    return place;
  }
  place.fixed = false;
  int chain[GAITD_MAX_JOINTS];
  int count = 0;
  for (int body = frame.body; body > 0; body = model.bodies[body].parent) {
    chain[count++] = model.bodies[body].joint;
  }
  const auto move = [&place](const Eigen::Vector3d& along) {
    place.position += along;
    place.velocity += place.rate.cross(along);
  };
  while (count-- > 0) {
    const int j = chain[count];
    const GaitdJoint& joint = model.joints[j];
    move(place.orientation * view(joint.origin));
    place.orientation = place.orientation * quaternion(joint.orientation);
    const Eigen::Vector3d axis = place.orientation * view(joint.axis);
    if (joint.type == GAITD_JOINT_PRISMATIC) {
      move(axis * q[j]);
      place.velocity += axis * qd[j];
    } else {
      place.orientation = place.orientation * exp_so3(q[j] * view(joint.axis));
      place.rate += axis * qd[j];
    }
  }
  move(place.orientation * view(frame.origin));
  place.orientation = (place.orientation * quaternion(frame.orientation)).normalized();
  return place;
}

/// Which joints (n) lie between the pelvis and an IMU of the model.
template <class Array>
void mark_joints_to_imus(const GaitdModel& model, Array& joints) {
  for (int i = 0; i < model.imu_count; ++i) {
    for (int body = model.imus[i].body; body > 0; body = model.bodies[body].parent) {
      joints[static_cast<std::size_t>(model.bodies[body].joint)] = true;
    }
  }
}

/// Mean rate of the pelvis (rad/s, its axes) over a tick of `dt` seconds, in which the IMU turned
/// with `rate` (rad/s, IMU axes) while its orientation in the pelvis went from `before` to `now`.
/// Unlike the difference of rates it adds up to the angles of the encoders: no error of joint rates
/// becomes a drift of the attitude.
inline Eigen::Vector3d pelvis_turn(const Eigen::Quaterniond& before, const Eigen::Quaterniond& now,
                                   const Eigen::Vector3d& rate, double dt) {
  return log_so3(before * exp_so3(dt * rate) * now.conjugate()) / dt;
}

}  // namespace gaitd::sdk
