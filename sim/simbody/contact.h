// SPDX-License-Identifier: Apache-2.0
// One touching point and its force law.
//
// Normal force k d (1 - c v) away from the terrain, never pulling; tangential spring and damper to
// an anchor, clamped to friction times the normal force, the anchor sliding only when clamped.
// Both are taken at the end of the step (linearly implicit), so the force is f0 - G v for the
// velocity v of the point after the step.
#ifndef GAITD_SIM_CONTACT_H_
#define GAITD_SIM_CONTACT_H_

#include <Eigen/Core>
#include <algorithm>

namespace gaitd::sim {

struct ContactLaw {
  double stiffness = 4e5;           // N/m per point, normal and tangential
  double dissipation = 1.0;         // s/m
  double tangential_damping = 300;  // N s/m
};

enum class ContactMode { kStick, kSlide, kApart };

struct Contact {
  int body = 0;
  int foot = -1;  // GAITD_LEFT, GAITD_RIGHT, or -1: another part of the robot
  ContactLaw law;
  double friction = 0;
  double depth = 0;        // m
  Eigen::Vector3d p_W;     // m, the point in the world
  Eigen::Vector3d p_B;     // m, the point in the body: where its friction clings to
  Eigen::Vector3d normal;  // unit, W: direction of the force on the robot
  int memory = 0;          // its entry in the ContactMemory
  Eigen::Vector3d deflection = Eigen::Vector3d::Zero();  // m, W, tangential

  ContactMode mode = ContactMode::kStick;
  Eigen::Vector3d slide_direction = Eigen::Vector3d::Zero();  // unit, W: of friction, sliding
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  // N, W, on the robot, of the last step

  // Of linearise(): N and N s/m, W.
  Eigen::Vector3d f0 = Eigen::Vector3d::Zero();
  Eigen::Matrix3d g = Eigen::Matrix3d::Zero();

  // Sets f0 and G of the present mode for a step of `h` seconds. G is symmetric unless it slides.
  void linearise(double h) {
    f0.setZero();
    g.setZero();
    if (mode == ContactMode::kApart) return;
    const double kn = law.stiffness * (h + law.dissipation * depth);
    const double kt = law.stiffness * h + law.tangential_damping;
    const Eigen::Matrix3d nn = normal * normal.transpose();
    f0 = law.stiffness * depth * normal;
    g = kn * nn;
    if (mode == ContactMode::kStick) {
      f0 -= law.stiffness * deflection;
      g += kt * (Eigen::Matrix3d::Identity() - nn);
    } else {
      f0 += law.stiffness * depth * friction * slide_direction;
      g += kn * friction * slide_direction * normal.transpose();
    }
  }

  // Sets `force` for the velocity `v` (m/s, W) of the point after the step, by the law that was
  // linearised last.
  void update_force(const Eigen::Vector3d& v) { force = f0 - g * v; }

  double normal_force() const { return force.dot(normal); }

  bool pulls() const { return mode != ContactMode::kApart && normal_force() < 0; }

  // Is the force outside the friction cone, though the point should stick?
  bool slips() const {
    if (mode != ContactMode::kStick) return false;
    const double fn = normal_force();
    return (force - fn * normal).norm() > friction * std::max(0.0, fn);
  }

  // From sticking to sliding, friction pointing as the force does now.
  void slide() {
    mode = ContactMode::kSlide;
    slide_direction = (force - normal_force() * normal).normalized();
  }

  void release() {
    mode = ContactMode::kApart;
    force.setZero();
  }
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_CONTACT_H_
