// SPDX-License-Identifier: Apache-2.0
#ifndef GAITD_QP_SRC_THIN_QR_H_
#define GAITD_QP_SRC_THIN_QR_H_

#include <Eigen/Core>

namespace gaitd::qp {

/// B = Q R of a tall matrix whose columns come and go: Q is n × q with orthonormal columns, R is
/// upper triangular. Gram–Schmidt with reorthogonalisation to append, plane rotations to remove
/// (Daniel, Gragg, Kaufman & Stewart 1976). Vectors of length n are padded to whole SIMD vectors.
class ThinQr {
 public:
  /// Allocates for n ≤ max_n and q ≤ max_n; nothing else here allocates.
  explicit ThinQr(int max_n);

  /// Empties the factorisation and sets the length of the columns.
  void reset(int n);
  int size() const { return size_; }
  /// Whether no further independent column can exist.
  bool full() const { return size_ >= n_; }

  /// d = Qᵀ b and z = b − Q d; returns ‖z‖². d has length size().
  double project(const double* b, double* d, double* z) const;
  /// Appends the column b = Q d + z with ‖z‖² > 0 as project() gave it.
  void append(const double* d, const double* z, double squared_norm);
  /// Removes column k of B.
  void remove(int k);

  /// r = R⁻¹ d.
  void solve(const double* d, double* r) const;
  /// p = R⁻ᵀ v.
  void solve_transposed(const double* v, double* p) const;
  /// out = Qᵀ v.
  void multiply_transposed(const double* v, double* out) const;
  /// out += sign · Q p.
  void multiply_add(const double* p, double sign, double* out) const;

 private:
  double* q_column(int k) { return q_.data() + static_cast<Eigen::Index>(k) * ldq_; }
  double* r_column(int k) { return r_.data() + static_cast<Eigen::Index>(k) * ldr_; }
  const double* r_column(int k) const { return r_.data() + static_cast<Eigen::Index>(k) * ldr_; }

  int n_ = 0;
  int ldq_ = 0;
  int ldr_ = 0;
  int size_ = 0;
  Eigen::VectorXd q_;
  Eigen::VectorXd r_;
  Eigen::VectorXd inverse_diagonal_;
  mutable Eigen::VectorXd correction_;
};

}  // namespace gaitd::qp

#endif  // GAITD_QP_SRC_THIN_QR_H_
