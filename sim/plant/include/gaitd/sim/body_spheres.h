// SPDX-License-Identifier: Apache-2.0
// The shape of everything but the soles: spheres on the trunk, the knees, the ankles and along the
// arms, so that a robot that has fallen lies on the terrain. The robot never touches itself.
#ifndef GAITD_SIM_BODY_SPHERES_H_
#define GAITD_SIM_BODY_SPHERES_H_

#include <Eigen/Core>
#include <vector>

#include "gaitd/abi/types.h"

namespace gaitd::sim {

struct BodySphere {
  int body;
  Eigen::Vector3d center;  // m, body frame
  double radius;           // m
};

// The spheres of a robot, found from its structure.
std::vector<BodySphere> make_body_spheres(const GaitdModel& model);

}  // namespace gaitd::sim

#endif  // GAITD_SIM_BODY_SPHERES_H_
