// SPDX-License-Identifier: Apache-2.0
// Small matrices of bodies and frames.
#ifndef GAITD_SIM_RIGID_BODY_H_
#define GAITD_SIM_RIGID_BODY_H_

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "gaitd/abi/types.h"

namespace gaitd::sim {

// cross_matrix(v) w = v x w.
inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// kg m^2, about the centre of mass, body axes.
inline Eigen::Matrix3d central_inertia(const GaitdBody& body) {
  const double* i = body.inertia;
  Eigen::Matrix3d m;
  m << i[0], i[1], i[2], i[1], i[3], i[4], i[2], i[4], i[5];
  return m;
}

// Of the frame in its body.
inline Eigen::Matrix3d rotation(const GaitdFrame& frame) {
  return Eigen::Quaterniond(frame.orientation).toRotationMatrix();
}

}  // namespace gaitd::sim

#endif  // GAITD_SIM_RIGID_BODY_H_
