// SPDX-License-Identifier: Apache-2.0
// Eigen views of the plain structs of gaitd/abi/types.h. No copies but for quaternions.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "gaitd/abi/types.h"

namespace gaitd::sdk {

using Vector6d = Eigen::Matrix<double, 6, 1>;

template <int N>
Eigen::Map<Eigen::Matrix<double, N, 1>> view(double (&a)[N]) {
  return Eigen::Map<Eigen::Matrix<double, N, 1>>(a);
}
template <int N>
Eigen::Map<const Eigen::Matrix<double, N, 1>> view(const double (&a)[N]) {
  return Eigen::Map<const Eigen::Matrix<double, N, 1>>(a);
}
// The first `n` entries of an array of joints.
template <int N>
Eigen::Map<Eigen::VectorXd> head(double (&a)[N], int n) {
  return Eigen::Map<Eigen::VectorXd>(a, n);
}
template <int N>
Eigen::Map<const Eigen::VectorXd> head(const double (&a)[N], int n) {
  return Eigen::Map<const Eigen::VectorXd>(a, n);
}

inline Eigen::Quaterniond quaternion(const double (&a)[4]) {
  return Eigen::Quaterniond(a[3], a[0], a[1], a[2]);
}
inline void store(const Eigen::Quaterniond& q, double (&a)[4]) {
  a[0] = q.x();
  a[1] = q.y();
  a[2] = q.z();
  a[3] = q.w();
}

// Roll, pitch, yaw (rad) of the Z-Y-X convention: R = Rz(yaw) Ry(pitch) Rx(roll).
inline Eigen::Vector3d roll_pitch_yaw(const Eigen::Quaterniond& q) {
  const Eigen::Matrix3d r = q.toRotationMatrix();
  return {std::atan2(r(2, 1), r(2, 2)), std::atan2(-r(2, 0), std::hypot(r(0, 0), r(1, 0))),
          std::atan2(r(1, 0), r(0, 0))};
}
inline double yaw_of(const Eigen::Quaterniond& q) { return roll_pitch_yaw(q).z(); }
inline Eigen::Quaterniond from_roll_pitch_yaw(double roll, double pitch, double yaw) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                            Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                            Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()));
}
inline Eigen::Quaterniond from_yaw(double yaw) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
}

// Rotation vector (rad) of q, the log map of SO(3); the short way round.
inline Eigen::Vector3d log_so3(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d v = sign * q.vec();
  const double s = v.norm();
  const double c = sign * q.w();
  if (s < 1e-12) return 2.0 * v;
  return (2.0 * std::atan2(s, c) / s) * v;
}
// Unit quaternion of a rotation vector (rad), the exponential map of SO(3).
inline Eigen::Quaterniond exp_so3(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  const double k = angle < 1e-9 ? 0.5 : std::sin(0.5 * angle) / angle;
  Eigen::Quaterniond q;
  q.w() = std::cos(0.5 * angle);
  q.vec() = k * w;
  return q.normalized();
}

// Point given in the frame of `pose`, in the parent frame of that pose.
inline Eigen::Vector3d transform(const GaitdPose& pose, const Eigen::Vector3d& p) {
  return view(pose.position) + quaternion(pose.orientation) * p;
}

}  // namespace gaitd::sdk
