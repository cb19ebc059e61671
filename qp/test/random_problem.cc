// SPDX-License-Identifier: Apache-2.0
#include "random_problem.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace gaitd::qp::testing {
namespace {

Eigen::MatrixXd random_square(int n, int rank, double condition, Random* random) {
  Eigen::MatrixXd factor = random->matrix(std::max(rank, 0), n);
  for (int i = 0; i < factor.rows(); ++i) {
    factor.row(i) *= std::pow(condition, random->uniform(-0.25, 0.25));
  }
  Eigen::MatrixXd h = factor.transpose() * factor;
  if (rank >= n) h.diagonal().array() += 1.0 / std::sqrt(condition);
  return h;
}

Eigen::MatrixXd random_hessian(const RandomProblemSpec& spec, Random* random) {
  const int n = spec.size.unknowns;
  const int rank = spec.rank < 0 ? n : spec.rank;
  if (spec.hessian == HessianKind::dense) return random_square(n, rank, spec.condition, random);
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(n, n);
  const int dense = spec.hessian == HessianKind::diagonal ? 0 : n / 2;
  h.topLeftCorner(dense, dense) =
      random_square(dense, std::min(dense, rank), spec.condition, random);
  for (int i = dense; i < std::max(rank, dense); ++i) {
    h(i, i) = std::pow(spec.condition, random->uniform(-0.5, 0.5));
  }
  return h;
}

// Draws the sides of one two-sided row around its value; returns its multiplier.
double draw_sides(double value, bool active, Random* random, double* lower, double* upper) {
  const bool at_upper = random->chance(0.5);
  *lower = random->chance(0.15) ? -kInfinity : value - random->uniform(0.01, 3.0);
  *upper = random->chance(0.15) ? kInfinity : value + random->uniform(0.01, 3.0);
  if (!active) return 0.0;
  (at_upper ? *upper : *lower) = value;
  return (at_upper ? 1.0 : -1.0) * random->uniform(0.01, 5.0);
}

}  // namespace

OwnedProblem::OwnedProblem(const Dimensions& d)
    : H(Eigen::MatrixXd::Zero(d.unknowns, d.unknowns)),
      A(Eigen::MatrixXd::Zero(d.equalities, d.unknowns)),
      C(Eigen::MatrixXd::Zero(d.inequalities, d.unknowns)),
      g(Eigen::VectorXd::Zero(d.unknowns)),
      b(Eigen::VectorXd::Zero(d.equalities)),
      l(Eigen::VectorXd::Constant(d.inequalities, -kInfinity)),
      u(Eigen::VectorXd::Constant(d.inequalities, kInfinity)),
      lb(Eigen::VectorXd::Constant(d.unknowns, -kInfinity)),
      ub(Eigen::VectorXd::Constant(d.unknowns, kInfinity)) {}

std::uint64_t Random::bits() {
  std::uint64_t v = (state_ += 0x9e3779b97f4a7c15ULL);
  v = (v ^ (v >> 30)) * 0xbf58476d1ce4e5b9ULL;
  v = (v ^ (v >> 27)) * 0x94d049bb133111ebULL;
  return v ^ (v >> 31);
}

double Random::uniform(double low, double high) {
  return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1.0p-53);
}

int Random::integer(int low, int high) {
  return low + static_cast<int>(bits() % static_cast<std::uint64_t>(high - low + 1));
}

Eigen::VectorXd Random::vector(int n) { return matrix(n, 1); }

Eigen::MatrixXd Random::matrix(int rows, int cols) {
  Eigen::MatrixXd m(rows, cols);
  for (int j = 0; j < cols; ++j) {
    for (int i = 0; i < rows; ++i) m(i, j) = uniform(-1.0, 1.0);
  }
  return m;
}

SolvedProblem make_random_problem(const RandomProblemSpec& spec, Random* random) {
  const auto [n, p, m] = spec.size;
  SolvedProblem result;
  OwnedProblem& problem = result.problem;
  problem = OwnedProblem(spec.size);
  problem.H = random_hessian(spec, random);
  problem.A = random->matrix(p, n);
  problem.C = random->matrix(m, n);
  result.x = 2.0 * random->vector(n);
  result.y = 3.0 * random->vector(p);
  problem.b = problem.A * result.x;

  std::vector<int> order(m + n);
  std::iota(order.begin(), order.end(), 0);
  for (int i = m + n - 1; i > 0; --i) std::swap(order[i], order[random->integer(0, i)]);
  const int count = static_cast<int>(spec.active_fraction * std::max(n - p, 0));
  std::vector<bool> active(m + n, false);
  for (int i = 0; i < count; ++i) active[order[i]] = true;

  const Eigen::VectorXd cx = problem.C * result.x;
  result.z.resize(m);
  result.w.resize(n);
  for (int i = 0; i < m; ++i) {
    result.z[i] = draw_sides(cx[i], active[i], random, &problem.l[i], &problem.u[i]);
  }
  for (int i = 0; i < n; ++i) {
    result.w[i] = draw_sides(result.x[i], active[m + i], random, &problem.lb[i], &problem.ub[i]);
  }
  problem.g = -(problem.H * result.x + problem.A.transpose() * result.y +
                problem.C.transpose() * result.z + result.w);
  return result;
}

KktResiduals judge(const Problem& problem, const Result& result) {
  KktJudge own(problem.dimensions());
  return own.evaluate(problem, result.point());
}

}  // namespace gaitd::qp::testing
