// SPDX-License-Identifier: Apache-2.0
// Reads a robot description (URDF) into the model that crosses the plugin boundary.
#ifndef GAITD_DYNAMICS_URDF_H_
#define GAITD_DYNAMICS_URDF_H_

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "gaitd/abi/types.h"

namespace gaitd::dynamics {

struct UrdfOptions {
  // Link whose frame becomes the frame of body 0 (the pelvis). Joints between it and the root of
  // the file are turned around: they carry the parent instead of the child. Empty: the root.
  std::string root_link;
  // Axes and origin (m) of body 0 in that link: for one whose x axis does not point forward, or
  // whose frame lies far from the hips.
  Eigen::Quaterniond R_LB = Eigen::Quaterniond::Identity();
  Eigen::Vector3d p_LB = Eigen::Vector3d::Zero();
  Eigen::Isometry3d X_LB() const { return Eigen::Translation3d(p_LB) * R_LB.normalized(); }
  // Joints, names or globs, that count as fixed: at zero, or where their range is nearest to it.
  std::vector<std::string> fixed;
  // Whether a moving joint without effort, velocity or range is an error. If not, it gets
  // kNoUrdfLimit: whoever asks knows them from elsewhere.
  bool limits_required = true;
  // Whether inertias that no rigid body has, by more than rounding, are moved to the nearest
  // possible ones. If not, they are errors.
  bool nearest_inertias = false;
};

// N m, rad/s and rad: of what the file does not limit, as the range of a continuous joint.
inline constexpr double kNoUrdfLimit = 1e9;

// Where a link of the file went. Links on fixed joints are merged into the body that carries them.
struct UrdfLink {
  std::string name;
  int body = 0;
  Eigen::Vector3d p_BL = Eigen::Vector3d::Zero();            // m, link frame origin in the body
  Eigen::Quaterniond R_BL = Eigen::Quaterniond::Identity();  // link frame in the body frame
};

struct UrdfResult {
  // Meaningful only if ok(). Filled: size, name, total_mass, gravity (9.81 m/s^2), the bodies and
  // the joints (rotor_inertia 0, damping from <dynamics>). All else is zero: frames, feet, legs and
  // the nominal posture come from the configuration of the robot.
  GaitdModel model{};
  std::vector<UrdfLink> links;      // every link of the file, in the order of the bodies
  std::vector<std::string> errors;  // everything that is wrong with the file, not only the first
  // What was taken differently from how it stands there: joints that mimic another one are fixed,
  // inertias that no rigid body has are moved to the nearest possible one.
  std::vector<std::string> warnings;
  bool far_inertias = false;              // one of them by more than rounding
  std::vector<std::string> unused_fixed;  // entries of UrdfOptions::fixed that no joint matches
  // Revolute and prismatic ones of which the file gives neither lower nor upper, or the same for
  // both.
  std::vector<std::string> joints_without_range;

  bool ok() const { return errors.empty(); }
  const UrdfLink* find_link(const std::string& name) const;  // nullptr if there is none
};

// Reads the file at `path`. Joints are numbered depth-first from the root, the joints of one link
// in alphabetical order; body i + 1 is what joint i carries and its frame is the joint frame at
// position zero (of a joint that was turned around: of its child link). Revolute, continuous
// (limits +-1e9 rad), prismatic and fixed joints are taken, and a floating one between an empty
// root and the robot. Joints with <mimic> are fixed.
// Never throws on a bad file: every problem becomes a text in `errors` that says where (file and
// line), what was found, what was expected and what to do. Allocates; not for the real-time path.
UrdfResult load_urdf(const std::string& path, const UrdfOptions& options = {});

// The same from text; `source` stands for the file name in errors.
UrdfResult load_urdf_text(const std::string& text, const std::string& source = "<text>",
                          const UrdfOptions& options = {});

}  // namespace gaitd::dynamics

#endif  // GAITD_DYNAMICS_URDF_H_
