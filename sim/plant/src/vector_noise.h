// SPDX-License-Identifier: Apache-2.0
// Random vectors of three axes.
#ifndef GAITD_SIM_VECTOR_NOISE_H_
#define GAITD_SIM_VECTOR_NOISE_H_

#include <Eigen/Core>

#include "gaitd/sim/random.h"

namespace gaitd::sim {

// Each axis of mean 0 and standard deviation 1.
inline Eigen::Vector3d normal_vector(RandomStream* stream) {
  Eigen::Vector3d v;
  for (int k = 0; k < 3; ++k) v[k] = stream->normal();
  return v;
}

// Takes nothing from `stream` if `sigma` is zero.
inline Eigen::Vector3d noise(RandomStream* stream, double sigma) {
  if (sigma == 0) return Eigen::Vector3d::Zero();
  return sigma * normal_vector(stream);
}

}  // namespace gaitd::sim

#endif  // GAITD_SIM_VECTOR_NOISE_H_
