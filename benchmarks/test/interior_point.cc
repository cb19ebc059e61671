// SPDX-License-Identifier: Apache-2.0
#include "interior_point.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

namespace gaitd::benchmarks {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd matrix(const qp::MatrixView& v) {
  MatrixXd m(v.rows(), v.cols());
  for (int j = 0; j < v.cols(); ++j) {
    for (int i = 0; i < v.rows(); ++i) m(i, j) = v(i, j);
  }
  return m;
}
VectorXd vector(const qp::VectorView& v) { return Eigen::Map<const VectorXd>(v.data(), v.size()); }

// Largest step that keeps v + step dv at or above zero, at most 1.
double longest_step(const VectorXd& v, const VectorXd& dv) {
  double step = 1.0;
  for (int i = 0; i < v.size(); ++i) {
    if (dv[i] < 0.0) step = std::min(step, -v[i] / dv[i]);
  }
  return step;
}

}  // namespace

VectorXd solve_by_interior_point(const qp::Problem& p) {
  const auto [n, equalities, rows] = p.dimensions();
  MatrixXd H = matrix(p.H).selfadjointView<Eigen::Lower>();
  const VectorXd g = vector(p.g), b = vector(p.b);
  const MatrixXd A = matrix(p.A), C = matrix(p.C);
  // All inequalities as G x <= h.
  std::vector<VectorXd> normals;
  std::vector<double> sides;
  const auto add = [&](const VectorXd& normal, double lower, double upper) {
    if (std::isfinite(upper)) normals.push_back(normal), sides.push_back(upper);
    if (std::isfinite(lower)) normals.push_back(-normal), sides.push_back(-lower);
  };
  for (int i = 0; i < rows; ++i) add(C.row(i), p.l[i], p.u[i]);
  for (int i = 0; i < n; ++i) add(VectorXd::Unit(n, i), p.lb[i], p.ub[i]);
  const int m = static_cast<int>(normals.size());
  MatrixXd G(m, n);
  VectorXd h(m);
  for (int i = 0; i < m; ++i) {
    G.row(i) = normals[i];
    h[i] = sides[i];
  }

  VectorXd x = VectorXd::Zero(n), y = VectorXd::Zero(equalities);
  VectorXd s = (h - G * x).cwiseMax(1.0), z = VectorXd::Ones(m);
  MatrixXd kkt = MatrixXd::Zero(n + equalities, n + equalities);
  VectorXd right(n + equalities);
  for (int iteration = 0; iteration < 200; ++iteration) {
    const VectorXd dual = H * x + g + A.transpose() * y + G.transpose() * z;
    const VectorXd primal = A * x - b;
    const VectorXd slack = G * x + s - h;
    const double mu = s.dot(z) / m;
    const double scale = 1.0 + x.cwiseAbs().maxCoeff();
    if (std::max({primal.cwiseAbs().maxCoeff(), slack.cwiseAbs().maxCoeff()}) < 1e-10 * scale &&
        dual.cwiseAbs().maxCoeff() < 1e-9 * (1.0 + g.cwiseAbs().maxCoeff()) && mu < 1e-11) {
      return x;
    }
    kkt.topLeftCorner(n, n) = H + G.transpose() * z.cwiseQuotient(s).asDiagonal() * G;
    kkt.topRightCorner(n, equalities) = A.transpose();
    kkt.bottomLeftCorner(equalities, n) = A;
    const Eigen::PartialPivLU<MatrixXd> factor(kkt);
    VectorXd dx, dy, ds, dz;
    const auto direction = [&](const VectorXd& complementarity) {
      right.head(n) =
          -dual - G.transpose() * ((z.cwiseProduct(slack) - complementarity).cwiseQuotient(s));
      right.tail(equalities) = -primal;
      const VectorXd step = factor.solve(right);
      dx = step.head(n);
      dy = step.tail(equalities);
      ds = -slack - G * dx;
      dz = -(complementarity + z.cwiseProduct(ds)).cwiseQuotient(s);
    };
    direction(s.cwiseProduct(z));
    const double affine = std::min(longest_step(s, ds), longest_step(z, dz));
    const double reached = (s + affine * ds).dot(z + affine * dz) / m;
    const double centre = std::pow(reached / mu, 3) * mu;
    direction((s.cwiseProduct(z) + ds.cwiseProduct(dz)).array() - centre);
    const double step = 0.995 * std::min(longest_step(s, ds), longest_step(z, dz));
    x += step * dx;
    y += step * dy;
    s += step * ds;
    z += step * dz;
  }
  return {};
}

}  // namespace gaitd::benchmarks
