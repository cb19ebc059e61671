// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "random_problem.h"

namespace gaitd::qp {
namespace {

using testing::kMax;

using testing::HessianKind;
using testing::make_random_problem;
using testing::OwnedProblem;
using testing::Random;
using testing::RandomProblemSpec;
using testing::to_vector;

TEST(SingularHessian, RankDeficientProblemsReachTheKktOfTheOriginal) {
  DenseSolver solver(kMax);
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    Random random(seed);
    RandomProblemSpec spec;
    const int n = random.integer(5, 80);
    spec.size = {n, random.integer(0, std::min(10, n)), random.integer(0, 60)};
    spec.hessian = static_cast<HessianKind>(random.integer(0, 2));
    spec.rank = random.integer(0, n);
    spec.condition = 1e2;
    spec.active_fraction = random.uniform(0.2, 1.0);
    const auto known = make_random_problem(spec, &random);
    const Problem problem = known.problem.view();
    const Result result = solver.solve(problem);
    ASSERT_EQ(result.status, Status::solved)
        << "seed " << seed << " residual " << result.residuals.scaled.max();
    ASSERT_LE(testing::judge(problem, result).scaled.max(), 1e-8) << "seed " << seed;
    // The solution need not be unique, its value is.
    const double value =
        0.5 * known.x.dot(known.problem.H * known.x) + known.problem.g.dot(known.x);
    ASSERT_NEAR(result.objective, value, 1e-6 * (1.0 + std::abs(value))) << "seed " << seed;
  }
}

TEST(SingularHessian, LinearProgramOverABoxEndsInItsCorner) {
  OwnedProblem problem({40, 0, 0});
  Random random(3);
  problem.g = random.vector(40);
  problem.lb.setConstant(-2.0);
  problem.ub.setConstant(7.0);
  DenseSolver solver(kMax);
  const Result result = solver.solve(problem.view());
  ASSERT_EQ(result.status, Status::solved);
  for (int i = 0; i < 40; ++i) EXPECT_EQ(result.x[i], problem.g[i] > 0.0 ? -2.0 : 7.0);
}

TEST(SingularHessian, LinearProgramsWithVertices) {
  DenseSolver solver(kMax);
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    RandomProblemSpec spec;
    spec.size = {random.integer(2, 60), 2, random.integer(20, 96)};
    spec.rank = 0;
    spec.active_fraction = 1.0;
    const auto known = make_random_problem(spec, &random);
    const Result result = solver.solve(known.problem.view());
    ASSERT_EQ(result.status, Status::solved) << "seed " << seed;
    ASSERT_LE((to_vector(result.x) - known.x).cwiseAbs().maxCoeff(), 1e-6) << "seed " << seed;
  }
}

TEST(SingularHessian, ZeroCostAsksForFeasibilityOnly) {
  OwnedProblem problem({10, 2, 3});
  Random random(5);
  problem.A = random.matrix(2, 10);
  problem.b = random.vector(2);
  problem.C = random.matrix(3, 10);
  problem.l.setConstant(0.1);
  DenseSolver solver(kMax);
  const Result result = solver.solve(problem.view());
  ASSERT_EQ(result.status, Status::solved);
  EXPECT_LE(testing::judge(problem.view(), result).absolute.max(), 1e-10);
}

TEST(SingularHessian, UnboundedProblemEndsAsMaxIterations) {
  OwnedProblem problem({3, 0, 1});
  problem.H(0, 0) = 1.0;
  problem.g << 1.0, -1.0, 0.5;
  problem.C << 1.0, 0.0, 1.0;
  problem.l << -1.0;
  DenseSolver solver(kMax);
  const Result result = solver.solve(problem.view());
  EXPECT_EQ(result.status, Status::max_iterations);
  EXPECT_LE(result.iterations, Options{}.max_iterations);
}

TEST(SingularHessian, IndefiniteHessianIsRefused) {
  OwnedProblem problem({3, 0, 0});
  problem.H.diagonal() << 1.0, -0.5, 2.0;
  problem.lb.setConstant(-1.0);
  problem.ub.setConstant(1.0);
  DenseSolver solver(kMax);
  EXPECT_EQ(solver.solve(problem.view()).status, Status::non_convex);
  problem.H.diagonal() << 0.0, 0.0, 0.0;
  problem.H(1, 0) = 1.0;
  EXPECT_EQ(solver.solve(problem.view()).status, Status::non_convex);
}

TEST(SingularHessian, NearlySingularHessiansStayAccurate) {
  DenseSolver solver(kMax);
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Random random(seed);
    RandomProblemSpec spec;
    const int n = random.integer(10, 70);
    spec.size = {n, 6, 30};
    spec.rank = n - random.integer(1, 8);
    spec.active_fraction = random.uniform(0.0, 1.0);
    auto known = make_random_problem(spec, &random);
    const double ridge = std::pow(10.0, random.uniform(-14.0, -4.0));
    known.problem.H.diagonal().array() += ridge;
    known.problem.g -= ridge * known.x;
    const Result result = solver.solve(known.problem.view());
    ASSERT_EQ(result.status, Status::solved)
        << "seed " << seed << " residual " << result.residuals.scaled.max();
    ASSERT_LE(testing::judge(known.problem.view(), result).scaled.max(), 1e-8);
  }
}

}  // namespace
}  // namespace gaitd::qp
