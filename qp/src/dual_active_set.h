// SPDX-License-Identifier: Apache-2.0
#ifndef GAITD_QP_SRC_DUAL_ACTIVE_SET_H_
#define GAITD_QP_SRC_DUAL_ACTIVE_SET_H_

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "block_cholesky.h"
#include "constraint_set.h"
#include "thin_qr.h"

namespace gaitd::qp {

/// The dual active set method (Goldfarb & Idnani 1983) for strictly convex problems.
///
/// With H = L Lᵀ the working normals N are kept as L⁻¹N = Q R, Q thin; the minimiser on the working
/// set is then x = L⁻ᵀ(Q p − c), c = L⁻¹g, p = R⁻ᵀ(sides) + Qᵀc, with multipliers R⁻¹p. Every
/// iterate minimises over its working set with multipliers of the right sign; the dual objective
/// never falls, so no working set comes twice while rounding allows.
class DualActiveSet {
 public:
  enum class Outcome { optimal, infeasible, limit };

  explicit DualActiveSet(const Dimensions& max);

  /// Binds to a loaded problem and a factored Hessian; both must outlive the solve.
  void bind(const ConstraintSet* constraints, const BlockCholesky* cholesky);

  /// Sets the gradient at x = 0; padded vector of length n.
  void set_gradient(const double* g);

  /// Starts afresh from the equalities and the inequalities that `guess` marks (one entry per
  /// constraint: −1 lower, 1 upper, 0 none; null for none), as far as they are independent.
  /// `infeasible` when the equalities contradict each other by more than `tolerance`.
  Outcome build(const std::int8_t* guess, double tolerance);

  /// Minimises over the working set, drops what pulls the wrong way, and takes the result as the
  /// next start. Call after build() or set_gradient().
  void restart();

  /// Runs from the current start. `iterations` counts on up to `max_iterations`.
  Outcome run(int max_iterations, double tolerance, int* iterations);

  /// One step of iterative refinement, given H x + g − N λ of the problem to be solved.
  void correct(const double* stationarity);
  /// Takes the last correct() back.
  void revert();

  const double* x() const { return x_.data(); }
  double* mutable_x() { return x_.data(); }
  int size() const { return qr_.size(); }
  int id(int k) const { return id_[k]; }
  /// 1: held at the lower side, −1: at the upper side. Equalities: 1.
  double sign(int k) const { return sign_[k]; }
  double multiplier(int k) const { return lambda_[k]; }
  bool is_inequality(int k) const { return k >= fixed_; }

 private:
  enum State : std::int8_t { kInactive, kActive, kExcluded };
  struct Candidate {
    int id = -1;
    double sign = 0.0;
    double violation = 0.0;
  };

  double side(int id, double sign) const;
  double whiten(int id, double sign, double* out);
  bool try_append(int id, double sign, double threshold);
  void append(int id, double sign, double multiplier, double squared_norm);
  void remove(int k);
  void solve_working_set();
  void update_x();
  bool contradicts(int id, double sign, double tolerance);
  Candidate most_violated();
  Outcome add(Candidate candidate, int max_iterations, double tolerance, int* iterations);

  const ConstraintSet* constraints_ = nullptr;
  const BlockCholesky* cholesky_ = nullptr;
  ThinQr qr_;
  int n_ = 0;
  int padded_ = 0;
  int fixed_ = 0;  // leading entries of the working set that are equalities
  std::vector<int> id_;
  std::vector<double> sign_;
  std::vector<State> state_;
  Eigen::VectorXd lambda_, side_, p_, d_, r_;         // per working constraint
  Eigen::VectorXd x_, c_, normal_, z_, step_, work_;  // per unknown, padded
  Eigen::VectorXd values_;                            // per row
  Eigen::VectorXd previous_x_, previous_lambda_;
};

}  // namespace gaitd::qp

#endif  // GAITD_QP_SRC_DUAL_ACTIVE_SET_H_
