// SPDX-License-Identifier: Apache-2.0
// Sizes and names that the whole folder shares.
#ifndef GAITD_DYNAMICS_SPATIAL_H_
#define GAITD_DYNAMICS_SPATIAL_H_

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace gaitd::dynamics {

// Twists, accelerations and momenta: angular first. Wrenches: moment first.
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6X = Eigen::Matrix<double, 6, Eigen::Dynamic>;

// Of the floating base; joint i owns entry kBaseSize + i of every generalised vector.
inline constexpr int kBaseSize = 6;

}  // namespace gaitd::dynamics

#endif  // GAITD_DYNAMICS_SPATIAL_H_
