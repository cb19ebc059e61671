// SPDX-License-Identifier: Apache-2.0
#include "gaitd/qp/kkt.h"

#include <algorithm>
#include <cmath>

#include "kernels.h"

namespace gaitd::qp {
namespace {

// std::max drops a NaN second argument; a judge must not.
double max_keep_nan(double a, double b) { return (b > a || std::isnan(b)) ? b : a; }

// Accumulates the three conditions that concern one two-sided row.
struct TwoSided {
  double primal = 0.0;
  double primal_scaled = 0.0;
  double dual_sign = 0.0;
  double complementarity = 0.0;

  void add(double value, double lower, double upper, double multiplier, double scale) {
    const double excess = max_keep_nan(max_keep_nan(0.0, lower - value), value - upper);
    primal = max_keep_nan(primal, excess);
    primal_scaled = max_keep_nan(primal_scaled, excess / scale);
    if (multiplier == 0.0) return;
    const double distance = multiplier > 0.0 ? upper - value : value - lower;
    const double size = std::abs(multiplier);
    if (distance == kernels::kInfinity) {
      dual_sign = max_keep_nan(dual_sign, size);
    } else {
      complementarity = max_keep_nan(complementarity, size * std::abs(distance));
    }
  }
};

double max_abs_keep_nan(int n, const double* v) {
  double result = 0.0;
  for (int i = 0; i < n; ++i) result = max_keep_nan(result, std::abs(v[i]));
  return result;
}

}  // namespace

double KktNorms::max() const {
  double result = stationarity;
  for (double v : {primal_equality, primal_inequality, dual_sign, complementarity}) {
    result = std::isnan(result) ? result : max_keep_nan(result, v);
  }
  return result;
}

KktJudge::KktJudge(const Dimensions& max)
    : stationarity_(Eigen::VectorXd::Zero(max.unknowns)),
      equality_(Eigen::VectorXd::Zero(max.equalities)),
      inequality_(Eigen::VectorXd::Zero(max.inequalities)) {}

KktResiduals KktJudge::evaluate(const Problem& problem, const Point& point) {
  const auto [n, p, m] = problem.dimensions();
  const double* x = point.x.data();
  double* s = stationarity_.data();
  double* eq = equality_.data();
  double* cx = inequality_.data();

  // H x from the lower triangle alone.
  std::fill_n(s, n, 0.0);
  for (int j = 0; j < n; ++j) {
    const double* h = problem.H.column(j);
    const int below = n - j - 1;
    s[j] += h[j] * x[j] + kernels::axpy_dot(below, x[j], h + j + 1, s + j + 1, x + j + 1);
  }
  const double quadratic = kernels::dot(n, x, s);
  const double linear = kernels::dot(n, problem.g.data(), x);
  objective_ = 0.5 * quadratic + linear;
  double dual_scale = max_keep_nan(max_abs_keep_nan(n, s), max_abs_keep_nan(n, problem.g.data()));
  kernels::axpy(n, 1.0, problem.g.data(), s);

  std::fill_n(eq, p, 0.0);
  std::fill_n(cx, m, 0.0);
  for (int j = 0; j < n; ++j) {
    double aty = 0.0;
    double ctz = 0.0;
    if (p > 0) aty = kernels::axpy_dot(p, x[j], problem.A.column(j), eq, point.y.data());
    if (m > 0) ctz = kernels::axpy_dot(m, x[j], problem.C.column(j), cx, point.z.data());
    const double w = point.w[j];
    dual_scale = max_keep_nan(dual_scale, std::abs(aty));
    dual_scale = max_keep_nan(dual_scale, std::abs(ctz));
    dual_scale = max_keep_nan(dual_scale, std::abs(w));
    s[j] += aty + ctz + w;
  }

  KktResiduals result;
  result.absolute.stationarity = max_abs_keep_nan(n, s);
  double equality_scale =
      max_keep_nan(max_abs_keep_nan(p, eq), max_abs_keep_nan(p, problem.b.data()));
  if (p > 0) kernels::axpy(p, -1.0, problem.b.data(), eq);
  result.absolute.primal_equality = max_abs_keep_nan(p, eq);

  TwoSided sides;
  const double row_scale = 1.0 + max_abs_keep_nan(m, cx);
  for (int i = 0; i < m; ++i) {
    const double lower = problem.l.size() > 0 ? problem.l[i] : -kernels::kInfinity;
    const double upper = problem.u.size() > 0 ? problem.u[i] : kernels::kInfinity;
    sides.add(cx[i], lower, upper, point.z[i], row_scale);
  }
  for (int i = 0; i < n; ++i) {
    const double lower = problem.lb.size() > 0 ? problem.lb[i] : -kernels::kInfinity;
    const double upper = problem.ub.size() > 0 ? problem.ub[i] : kernels::kInfinity;
    sides.add(x[i], lower, upper, point.w[i], 1.0 + std::abs(x[i]));
  }
  result.absolute.primal_inequality = sides.primal;
  result.absolute.dual_sign = sides.dual_sign;
  result.absolute.complementarity = sides.complementarity;

  const double value_scale = max_keep_nan(std::abs(quadratic), std::abs(linear));
  result.scaled.stationarity = result.absolute.stationarity / (1.0 + dual_scale);
  result.scaled.primal_equality = result.absolute.primal_equality / (1.0 + equality_scale);
  result.scaled.primal_inequality = sides.primal_scaled;
  result.scaled.dual_sign = sides.dual_sign / (1.0 + dual_scale);
  result.scaled.complementarity = sides.complementarity / (1.0 + value_scale);
  return result;
}

}  // namespace gaitd::qp
