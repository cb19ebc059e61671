// SPDX-License-Identifier: Apache-2.0
// Is a GaitdModel a robot that the dynamics can compute with?
#ifndef GAITD_DYNAMICS_MODEL_CHECK_H_
#define GAITD_DYNAMICS_MODEL_CHECK_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "gaitd/abi/types.h"

namespace gaitd::dynamics {

// Everything that is wrong with the bodies, joints and gravity of `model`; empty if nothing is.
// Checked: the counts, the numbering (body i + 1 is moved by joint i, parents first), finite
// figures, positive masses, physical inertias, unit axes and quaternions, limits.
// Each text says where, what was expected and what was found. Allocates.
std::vector<std::string> check_model(const GaitdModel& model);

// Why `inertia` (kg m^2, about the centre of mass) cannot be that of a rigid body, or an empty
// text. It must be positive definite, and no principal moment may exceed the sum of the two
// others. With `allow_zero` a point or a thin rod passes too.
std::string check_inertia(const Eigen::Matrix3d& inertia, bool allow_zero);

// Moves an inertia (kg m^2, about the centre of mass) that no body has to the nearest possible one.
// False, and nothing is changed, when more than rounding is wrong with it, 5 % of its largest
// moment; with `far` also then, if it is positive definite.
bool make_physical(Eigen::Matrix3d* inertia, bool far = false);

}  // namespace gaitd::dynamics

#endif  // GAITD_DYNAMICS_MODEL_CHECK_H_
