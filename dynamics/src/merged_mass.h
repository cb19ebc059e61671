// SPDX-License-Identifier: Apache-2.0
#ifndef GAITD_DYNAMICS_SRC_MERGED_MASS_H_
#define GAITD_DYNAMICS_SRC_MERGED_MASS_H_

#include <Eigen/Core>

namespace gaitd::dynamics {

// Adds a rigid part to a body; all three quantities of both in the axes of the body.
struct MergedMass {
  double mass = 0;
  Eigen::Vector3d com = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  // about com

  void add(double part_mass, const Eigen::Vector3d& part_com, const Eigen::Matrix3d& part_inertia) {
    if (part_mass <= 0) return;
    const double total = mass + part_mass;
    const Eigen::Vector3d d = part_com - com;
    inertia +=
        part_inertia + (mass * part_mass / total) *
                           (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
    com += (part_mass / total) * d;
    mass = total;
  }
};

}  // namespace gaitd::dynamics

#endif  // GAITD_DYNAMICS_SRC_MERGED_MASS_H_
