// SPDX-License-Identifier: Apache-2.0
// The robot as a Simbody multibody system: where its bodies are, how they move, and the bias force.
#ifndef GAITD_SIM_MULTIBODY_H_
#define GAITD_SIM_MULTIBODY_H_

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/sim/motion.h"

namespace gaitd::sim {

class Multibody {
 public:
  // Throws std::invalid_argument if Simbody refuses a body (say an unphysical inertia).
  explicit Multibody(const GaitdModel& model);
  ~Multibody();
  Multibody(Multibody&&) noexcept;
  Multibody& operator=(Multibody&&) noexcept;

  int body_count() const;
  int joint_count() const;

  // Moves the system to `state`; body(), compute_bias() and mass_matrix() are of it from then on.
  void set_state(const State& state);
  const BodyMotion& body(int index) const;
  const std::vector<BodyMotion>& bodies() const;

  // c (6 + n, N m and N, ordered as State::u) in M(q) du/dt + c(q, u) = generalised force: the
  // velocity-dependent and gravity terms. Rotor inertia adds nothing to it.
  void compute_bias(Eigen::VectorXd* c) const;

  // Simbody's own joint-space inertia (6 + n square, without rotor inertia). Slow: it is the judge
  // of the one the integrator uses.
  Eigen::MatrixXd mass_matrix() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_MULTIBODY_H_
