// SPDX-License-Identifier: Apache-2.0
// What a URDF holds beyond the dynamics: shapes, sensors, and what its joints lack. For whoever
// describes a robot that nobody has described yet.
#ifndef GAITD_DYNAMICS_URDF_OUTLINE_H_
#define GAITD_DYNAMICS_URDF_OUTLINE_H_

#include <Eigen/Geometry>
#include <set>
#include <string>
#include <vector>

namespace gaitd::dynamics {

enum class ShapeKind { kBox, kCylinder, kCapsule, kSphere, kMesh };

struct UrdfShape {
  std::string link;
  bool collision = false;  // else a visual
  ShapeKind kind = ShapeKind::kBox;
  Eigen::Isometry3d X_LS = Eigen::Isometry3d::Identity();  // in the link frame
  // m: edges of a box; radius and length of a cylinder, which lies along z, or of one
  // between the caps of a capsule; radius of a sphere;
  // the scale of a mesh.
  Eigen::Vector3d size = Eigen::Vector3d::Ones();
  std::string file;  // of a mesh, as it stands there
};

struct UrdfJointNote {
  std::string name, parent, child, type;
  bool mimic = false;
  bool has_effort = false;  // and a velocity, both above 0
  bool has_range = true;    // an axis, and limits apart from each other where its type has some
  std::string mimicked;     // the joint that it follows
  bool broken = false;      // an axis of zero, or a lower end above the upper one
  double lower = 0.0, upper = 0.0;  // rad or m, as they stand there
};

// <sensor> in a <gazebo> of a link or joint.
struct UrdfSensor {
  std::string name, type, reference;  // reference: the link or joint
};

struct UrdfOutline {
  std::vector<UrdfShape> shapes;
  std::set<std::string> links_with_mass;
  std::vector<UrdfJointNote> joints;
  std::vector<UrdfSensor> sensors;
};

// Never fails: what cannot be read is left out. The reader of the dynamics says what is wrong.
UrdfOutline read_urdf_outline(const std::string& text);

// The text of a URDF file within the bound of its size; false and why in `error` otherwise.
bool read_urdf_text(const std::string& path, std::string* text, std::string* error);

}  // namespace gaitd::dynamics

#endif  // GAITD_DYNAMICS_URDF_OUTLINE_H_
