// SPDX-License-Identifier: Apache-2.0
// One plant step: linearly implicit Euler.
//
//   (M + sum h J^T G J) u+ = M u + h (tau0 - c + sum J^T f0),   q+ = q (+) h u+
//
// with every stiff force (contacts, stops, drive gains, damping) written as f0 - G v+. Where the
// solution breaks a law (a contact pulls or leaves its friction cone, a drive exceeds its limit, a
// stop pulls) that force changes its mode and the system is solved again.
#ifndef GAITD_SIM_INTEGRATOR_H_
#define GAITD_SIM_INTEGRATOR_H_

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

#include "contact.h"
#include "dynamics_terms.h"
#include "gaitd/abi/types.h"
#include "gaitd/sim/drives.h"
#include "gaitd/sim/joint_law.h"
#include "multibody.h"

namespace gaitd::sim {

class Integrator {
 public:
  // `h`: plant step, s.
  Integrator(const GaitdModel& model, double h);

  // Advances `state` by one step. `multibody` and `terms` are those of `state`; `external` (6 + n)
  // is any further generalised force (N, N m). Leaves the forces of the step in `contacts` and
  // `drives`. False, with `state` as it was: the result is not finite.
  bool step(const Multibody& multibody, const DynamicsTerms& terms, const Eigen::VectorXd& external,
            std::vector<Contact>* contacts, Drives* drives, State* state);

  // How often the last step solved its system: once, and once more for each change of modes.
  int solves() const { return solves_; }

 private:
  // What all contacts of a body do to it, as force and moment about the origin of the terms.
  struct TouchedBody {
    int body;
    Matrix6 stiffness;
    Vector6 wrench;
  };

  void solve(const DynamicsTerms& terms);
  // Linearises the contacts, which stay so until a mode changes: drives alone are revised more
  // often.
  void gather_contacts(const DynamicsTerms& terms, std::vector<Contact>* contacts);
  bool update_modes(const DynamicsTerms& terms, std::vector<Contact>* contacts);
  bool update_contacts(const DynamicsTerms& terms, std::vector<Contact>* contacts) const;

  static constexpr int kMaxSolves = 5;

  double h_;
  int joint_count_;
  JointLaw joints_;
  Eigen::VectorXd bias_;
  Eigen::VectorXd constant_;  // the right side without contacts, drives and stops
  Eigen::VectorXd joint_rate_;
  std::vector<TouchedBody> touched_;
  bool slides_ = false;  // does any contact?
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd solution_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::PartialPivLU<Eigen::MatrixXd> sliding_factor_;  // sliding makes the matrix unsymmetric
  int solves_ = 0;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_INTEGRATOR_H_
