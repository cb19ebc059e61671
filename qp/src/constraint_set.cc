// SPDX-License-Identifier: Apache-2.0
#include "constraint_set.h"

#include <algorithm>
#include <cmath>

#include "kernels.h"

namespace gaitd::qp {
ConstraintSet::ConstraintSet(const Dimensions& max) {
  const int rows = max.equalities + max.inequalities;
  normals_ = Eigen::VectorXd::Zero(rows * kernels::padded(max.unknowns));
  length_ = Eigen::VectorXd::Zero(rows);
  lower_ = Eigen::VectorXd::Zero(rows + max.unknowns);
  upper_ = lower_;
}

ConstraintSet::Check ConstraintSet::load(const Problem& problem, double tolerance) {
  const auto [n, p, m] = problem.dimensions();
  n_ = n;
  p_ = p;
  rows_ = p + m;
  ld_ = kernels::padded(n);
  for (Check check : {load_rows(problem.A, 0), load_rows(problem.C, p)}) {
    if (check != Check::ok) return check;
  }
  if (p > 0 && !kernels::all_finite(p, problem.b.data())) return Check::non_finite;
  Check result = Check::ok;
  for (Check check :
       {load_sides(problem.b, problem.b, 0, p), load_sides(problem.l, problem.u, p, m),
        load_sides(problem.lb, problem.ub, rows_, n)}) {
    if (check == Check::non_finite) return check;
    if (check == Check::infeasible) result = check;
  }
  return result == Check::ok ? finish_rows(tolerance) : result;
}

ConstraintSet::Check ConstraintSet::load_rows(const MatrixView& m, int first) {
  const int count = m.rows();
  if (count == 0) return Check::ok;
  double* target = normals_.data() + static_cast<Eigen::Index>(first) * ld_;
  double rest = 0.0;
  for (int j = 0; j < n_; ++j) {
    const double* source = m.column(j);
    if (!kernels::all_finite(count, source)) rest = kernels::kInfinity;
    for (int i = 0; i < count; ++i) target[i * ld_ + j] = source[i];
  }
  for (int i = 0; i < count; ++i) {
    std::fill(target + i * ld_ + n_, target + (i + 1) * ld_, 0.0);
  }
  return rest == 0.0 ? Check::ok : Check::non_finite;
}

ConstraintSet::Check ConstraintSet::load_sides(const VectorView& lower, const VectorView& upper,
                                               int first, int count) {
  Check result = Check::ok;
  for (int i = 0; i < count; ++i) {
    const double low = lower.size() > 0 ? lower[i] : -kernels::kInfinity;
    const double high = upper.size() > 0 ? upper[i] : kernels::kInfinity;
    if (std::isnan(low) || std::isnan(high)) return Check::non_finite;
    if (low > high || low == kernels::kInfinity || high == -kernels::kInfinity)
      result = Check::infeasible;
    lower_[first + i] = low;
    upper_[first + i] = high;
  }
  return result;
}

ConstraintSet::Check ConstraintSet::finish_rows(double tolerance) {
  for (int id = 0; id < rows_; ++id) {
    double* a = normals_.data() + static_cast<Eigen::Index>(id) * ld_;
    const double length = std::sqrt(kernels::dot(ld_, a, a));
    if (length == 0.0) {
      if (lower_[id] > tolerance || upper_[id] < -tolerance) return Check::infeasible;
      length_[id] = 1.0;
      lower_[id] = -kernels::kInfinity;
      upper_[id] = kernels::kInfinity;
      continue;
    }
    const double inverse = 1.0 / length;
    for (int j = 0; j < ld_; ++j) a[j] *= inverse;
    length_[id] = length;
    lower_[id] *= inverse;
    upper_[id] *= inverse;
  }
  return Check::ok;
}

double ConstraintSet::value(int id, const double* x) const {
  return is_bound(id) ? x[unknown_of(id)] : kernels::dot(ld_, normal(id), x);
}

void ConstraintSet::row_values(const double* x, double* out) const {
  kernels::multiply_transposed(ld_, rows_, normals_.data(), ld_, x, out);
}

void ConstraintSet::add_normal(int id, double weight, double* out) const {
  if (is_bound(id)) {
    out[unknown_of(id)] += weight;
  } else {
    kernels::axpy(ld_, weight, normal(id), out);
  }
}

}  // namespace gaitd::qp
