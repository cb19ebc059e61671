// SPDX-License-Identifier: Apache-2.0
// Joint-space inertia and Jacobians of the simulated robot, in world axes about the pelvis origin.
//
// Simbody's own mass matrix takes as long as all the rest of a step together; the composite-body
// sums below give the same figures (a test holds them to it) in a few microseconds.
#ifndef GAITD_SIM_DYNAMICS_TERMS_H_
#define GAITD_SIM_DYNAMICS_TERMS_H_

#include <Eigen/Core>
#include <vector>

#include "gaitd/abi/types.h"
#include "multibody.h"

namespace gaitd::sim {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

class DynamicsTerms {
 public:
  explicit DynamicsTerms(const GaitdModel& model);

  // Recomputes everything for the state that `multibody` is in.
  void update(const Multibody& multibody);

  int dof() const { return 6 + joint_count_; }

  // (6 + n) square, rotor inertia included, full storage, ordered as State::u.
  const Eigen::MatrixXd& mass_matrix() const { return mass_matrix_; }

  // Pelvis origin in W (m): the point that twists and wrenches below refer to.
  const Eigen::Vector3d& origin() const { return origin_; }

  // Adds scale * J^T K J to `matrix`, J (6 x dof) the Jacobian of the twist of `body` at origin(),
  // angular rows first. K need not be symmetric.
  void add_stiffness(int body, const Matrix6& k, double scale, Eigen::MatrixXd* matrix) const;

  // Adds scale * J^T wrench (moment first, about origin(), W) to `force`.
  void add_wrench(int body, const Vector6& wrench, double scale, Eigen::VectorXd* force) const;

  // J u: twist of `body` (angular first, W) with the velocity of its material point at origin().
  Vector6 twist(int body, const Eigen::VectorXd& u) const;

 private:
  int joint_count_;
  std::vector<GaitdBody> bodies_;
  std::vector<bool> prismatic_;
  std::vector<Eigen::Vector3d> axis_B_;
  std::vector<double> rotor_inertia_;
  std::vector<std::vector<int>> chain_;  // joints from each body up to the pelvis
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  std::vector<Vector6, Eigen::aligned_allocator<Vector6>> screw_;  // of each joint, about origin_
  std::vector<double> composite_mass_;
  std::vector<Eigen::Vector3d> composite_moment_;   // mass times (CoM - origin_)
  std::vector<Eigen::Matrix3d> composite_inertia_;  // about origin_
  Eigen::MatrixXd mass_matrix_;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_DYNAMICS_TERMS_H_
