// SPDX-License-Identifier: Apache-2.0
// The links and joints of a URDF file as they stand there, before they become a tree.
#ifndef GAITD_DYNAMICS_SRC_URDF_ELEMENTS_H_
#define GAITD_DYNAMICS_SRC_URDF_ELEMENTS_H_

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "gaitd/dynamics/urdf.h"
#include "xml_reader.h"

namespace gaitd::dynamics {

inline constexpr double kNoInertia = 1e-12;  // m^2, over the mass: of a point

struct UrdfLinkElement {
  int line = 0;
  std::string name;
  double mass = 0;  // kg; 0 without <inertial>
  Eigen::Vector3d com = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  // about the centre of mass, link axes
};

enum class UrdfJointKind { kFixed, kRevolute, kPrismatic, kFloating };

struct UrdfJointElement {
  int line = 0;
  std::string name;
  std::string parent;
  std::string child;
  UrdfJointKind kind = UrdfJointKind::kFixed;
  Eigen::Isometry3d X_PJ = Eigen::Isometry3d::Identity();  // of a locked one at its position
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  bool lacks_range = false;  // of one that has stops
  double lower = 0;
  double upper = 0;
  double velocity = 0;
  double effort = 0;
  double damping = 0;
};

struct UrdfElements {
  std::string robot_name;
  std::vector<UrdfLinkElement> links;
  std::vector<UrdfJointElement> joints;
  bool far_inertias = false;
};

// Everything wrong with single elements goes to `reader`; what hangs together wrongly does not.
// Joints that match `options.fixed`, names or globs, and those with <mimic> come out as kFixed,
// whatever their limits are. `unused` gets those of `options.fixed` that match none.
UrdfElements read_urdf_elements(const std::string& text, const UrdfOptions& options,
                                XmlReader* reader, std::vector<std::string>* unused);

}  // namespace gaitd::dynamics

#endif  // GAITD_DYNAMICS_SRC_URDF_ELEMENTS_H_
