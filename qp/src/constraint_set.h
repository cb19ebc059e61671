// SPDX-License-Identifier: Apache-2.0
#ifndef GAITD_QP_SRC_CONSTRAINT_SET_H_
#define GAITD_QP_SRC_CONSTRAINT_SET_H_

#include <Eigen/Core>
#include <vector>

#include "gaitd/qp/problem.h"

namespace gaitd::qp {

/// All constraints of a Problem as one list lower ≤ aᵀx ≤ upper: the rows of A, the rows of C, then
/// the bounds, numbered from zero. Rows are scaled to unit length, so that violations compare.
/// Normals are contiguous and padded with zeros to kernels::padded(n).
class ConstraintSet {
 public:
  enum class Check { ok, non_finite, infeasible };

  /// Allocates for problems up to `max`; nothing else here allocates.
  explicit ConstraintSet(const Dimensions& max);

  /// Copies and scales. `infeasible` when a lower side exceeds its upper side, or a zero row asks
  /// for more than `tolerance` from zero; `non_finite` for NaN sides and non-finite A, b, C.
  Check load(const Problem& problem, double tolerance);

  int unknowns() const { return n_; }
  int equality_rows() const { return p_; }
  int rows() const { return rows_; }
  int size() const { return rows_ + n_; }

  bool is_bound(int id) const { return id >= rows_; }
  int unknown_of(int id) const { return id - rows_; }
  /// Normal of a row (not of a bound), unit length, padded.
  const double* normal(int id) const {
    return normals_.data() + static_cast<Eigen::Index>(id) * ld_;
  }
  /// Length of the row before scaling: caller's multiplier = ours / length. 1 for bounds.
  double length(int id) const { return is_bound(id) ? 1.0 : length_[id]; }
  double lower(int id) const { return lower_[id]; }
  double upper(int id) const { return upper_[id]; }
  bool is_equality(int id) const { return lower_[id] == upper_[id]; }

  /// aᵀx for one constraint; x is padded.
  double value(int id, const double* x) const;
  /// aᵀx of every row; out has length rows().
  void row_values(const double* x, double* out) const;
  /// out += weight · a.
  void add_normal(int id, double weight, double* out) const;

 private:
  Check load_rows(const MatrixView& m, int first);
  Check load_sides(const VectorView& lower, const VectorView& upper, int first, int count);
  Check finish_rows(double tolerance);

  int n_ = 0;
  int p_ = 0;
  int rows_ = 0;
  int ld_ = 0;
  Eigen::VectorXd normals_;
  Eigen::VectorXd length_;
  Eigen::VectorXd lower_;
  Eigen::VectorXd upper_;
};

}  // namespace gaitd::qp

#endif  // GAITD_QP_SRC_CONSTRAINT_SET_H_
