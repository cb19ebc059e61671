// SPDX-License-Identifier: Apache-2.0
#ifndef GAITD_DYNAMICS_SRC_COLLADA_H_
#define GAITD_DYNAMICS_SRC_COLLADA_H_

#include <Eigen/Core>
#include <string>
#include <vector>

namespace gaitd::dynamics {

// Corners of every geometry that the scene of a COLLADA document shows, m; of every one when it
// has no scene. The vertical axis that the document names is not looked at, as ROS does not either.
void read_collada(const std::string& text, std::vector<Eigen::Vector3d>* points);

}  // namespace gaitd::dynamics

#endif  // GAITD_DYNAMICS_SRC_COLLADA_H_
