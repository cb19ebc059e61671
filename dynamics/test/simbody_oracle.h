// SPDX-License-Identifier: Apache-2.0
// The same robot in Simbody, whose code and formulation (order-n recursions in body frames) have
// nothing in common with ours. Results are converted to the conventions of gaitd::dynamics.
#ifndef GAITD_DYNAMICS_TEST_SIMBODY_ORACLE_H_
#define GAITD_DYNAMICS_TEST_SIMBODY_ORACLE_H_

#include <Eigen/Core>
#include <memory>

#include "gaitd/abi/types.h"
#include "gaitd/dynamics/spatial.h"
#include "random_model.h"

namespace gaitd::dynamics {

class SimbodyOracle {
 public:
  explicit SimbodyOracle(const GaitdModel& model);  // rotor inertia is left out
  ~SimbodyOracle();

  void set_state(const RandomState& state);

  Eigen::MatrixXd mass_matrix() const;
  Eigen::VectorXd inverse_dynamics(const Eigen::VectorXd& vdot) const;
  Eigen::VectorXd forward_dynamics(const Eigen::VectorXd& tau) const;
  Eigen::Isometry3d X_WB(int body) const;
  Vector6d frame_velocity(int body, const Eigen::Vector3d& p_BF) const;
  Matrix6X frame_jacobian(int body, const Eigen::Vector3d& p_BF) const;
  Vector6d frame_acceleration(int body, const Eigen::Vector3d& p_BF,
                              const Eigen::VectorXd& vdot) const;
  Eigen::Vector3d com() const;
  Eigen::Vector3d com_velocity() const;
  Vector6d centroidal_momentum() const;
  Matrix6X centroidal_momentum_matrix() const;
  Vector6d centroidal_momentum_rate(const Eigen::VectorXd& vdot) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gaitd::dynamics

#endif  // GAITD_DYNAMICS_TEST_SIMBODY_ORACLE_H_
