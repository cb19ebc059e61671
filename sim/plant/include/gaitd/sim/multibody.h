// SPDX-License-Identifier: Apache-2.0
// The robot as a Simbody multibody system: where its bodies are, how they move, and the bias force.
#ifndef GAITD_SIM_MULTIBODY_H_
#define GAITD_SIM_MULTIBODY_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>

#include "gaitd/abi/types.h"

namespace gaitd::sim {

// Generalised coordinates of a free pelvis and n joints.
struct State {
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();            // m, pelvis origin in W
  Eigen::Quaterniond R_WB = Eigen::Quaterniond::Identity();  // pelvis frame in W
  Eigen::VectorXd q;                                         // n, rad or m
  Eigen::VectorXd u;  // 6 + n: pelvis angular then linear velocity (of its origin), both in W;
                      // then the joint rates
};

struct BodyMotion {
  Eigen::Matrix3d R_WB;
  Eigen::Vector3d p_WB;  // m, body origin in W
  Eigen::Vector3d w_W;   // rad/s
  Eigen::Vector3d v_W;   // m/s, of the body origin

  Eigen::Vector3d point(const Eigen::Vector3d& p_B) const { return p_WB + R_WB * p_B; }
  Eigen::Vector3d velocity(const Eigen::Vector3d& p_W) const { return v_W + w_W.cross(p_W - p_WB); }
};

class Multibody {
 public:
  // Throws std::invalid_argument if Simbody refuses a body (say an unphysical inertia).
  explicit Multibody(const GaitdModel& model);
  ~Multibody();
  Multibody(const Multibody&) = delete;
  Multibody& operator=(const Multibody&) = delete;

  int body_count() const;
  int joint_count() const;

  // Moves the system to `state`; body(), compute_bias() and mass_matrix() are of it from then on.
  void set_state(const State& state);
  const BodyMotion& body(int index) const;

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
