// SPDX-License-Identifier: Apache-2.0
// The corners of a mesh: all that is needed to find the sole of a foot.
#ifndef GAITD_DYNAMICS_MESH_POINTS_H_
#define GAITD_DYNAMICS_MESH_POINTS_H_

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace gaitd::dynamics {

// The file that the name of a mesh in the URDF at `urdf` means; empty if there is none. A name
// with package:// or model:// is searched in the folders above the URDF, then where
// ROS_PACKAGE_PATH and AMENT_PREFIX_PATH lead; others are relative to the URDF. Nothing is fetched
// from anywhere else.
std::filesystem::path find_mesh(const std::filesystem::path& urdf, const std::string& name);

// Corners of a mesh (STL in either form, OBJ, COLLADA) in its own frame and unit, m when it says
// so. False and why in `error` for what cannot be read or is beyond the bounds.
bool read_mesh_points(const std::filesystem::path& file, std::vector<Eigen::Vector3d>* points,
                      std::string* error);

}  // namespace gaitd::dynamics

#endif  // GAITD_DYNAMICS_MESH_POINTS_H_
