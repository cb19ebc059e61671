// SPDX-License-Identifier: Apache-2.0
#ifndef GAITD_QP_TEST_RANDOM_PROBLEM_H_
#define GAITD_QP_TEST_RANDOM_PROBLEM_H_

#include <Eigen/Core>
#include <cstdint>
#include <limits>

#include "gaitd/qp/dense_solver.h"
#include "gaitd/qp/problem.h"

namespace gaitd::qp::testing {

inline constexpr Dimensions kMax{112, 40, 96};  // of the solvers of the tests
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Owns the data of a Problem.
struct OwnedProblem {
  Eigen::MatrixXd H, A, C;
  Eigen::VectorXd g, b, l, u, lb, ub;

  OwnedProblem() = default;
  /// Zero matrices and no bounds of the given sizes.
  explicit OwnedProblem(const Dimensions& d);
  Problem view() const { return {H, g, A, b, C, l, u, lb, ub}; }
};

/// Seeded numbers that do not depend on the standard library (SplitMix64).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits();
  double uniform(double low, double high);
  /// Both ends included.
  int integer(int low, int high);
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  Eigen::VectorXd vector(int n);
  Eigen::MatrixXd matrix(int rows, int cols);

 private:
  std::uint64_t state_;
};

enum class HessianKind { dense, block_diagonal, diagonal };

struct RandomProblemSpec {
  Dimensions size;
  HessianKind hessian = HessianKind::dense;
  int rank = -1;                  ///< of H; negative: full
  double active_fraction = 0.25;  ///< of the degrees of freedom left by the equalities
  double condition = 1e4;         ///< spread of the scales of H
};

/// A problem with its solution, from the optimality conditions: x and the multipliers are drawn
/// first, then the sides and the gradient that make them optimal.
struct SolvedProblem {
  OwnedProblem problem;
  Eigen::VectorXd x, y, z, w;
};

SolvedProblem make_random_problem(const RandomProblemSpec& spec, Random* random);

/// Residuals of a result computed by a judge of its own.
KktResiduals judge(const Problem& problem, const Result& result);

/// Copies a view.
inline Eigen::VectorXd to_vector(const VectorView& v) {
  return Eigen::Map<const Eigen::VectorXd>(v.data(), v.size());
}

}  // namespace gaitd::qp::testing

#endif  // GAITD_QP_TEST_RANDOM_PROBLEM_H_
