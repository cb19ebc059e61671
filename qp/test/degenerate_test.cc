// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "random_problem.h"

namespace gaitd::qp {
namespace {

using testing::kInfinity;
using testing::kMax;

using testing::make_random_problem;
using testing::OwnedProblem;
using testing::Random;
using testing::RandomProblemSpec;
using testing::to_vector;

Result solve_and_judge(DenseSolver* solver, const OwnedProblem& owned) {
  const Result result = solver->solve(owned.view());
  EXPECT_EQ(result.status, Status::solved) << to_string(result.status);
  EXPECT_LE(testing::judge(owned.view(), result).scaled.max(), 1e-8);
  return result;
}

TEST(Degenerate, ManyConstraintsThroughOnePoint) {
  DenseSolver solver(kMax);
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    const int n = random.integer(3, 30);
    OwnedProblem problem({n, 0, 96});
    problem.H.setIdentity();
    problem.g = random.vector(n) * 10.0;
    problem.C = random.matrix(96, n);
    const Eigen::VectorXd vertex = random.vector(n);
    problem.u = problem.C * vertex;
    problem.ub = vertex;
    solve_and_judge(&solver, problem);
  }
}

TEST(Degenerate, IntegerConesWithExactTies) {
  DenseSolver solver(kMax);
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    const int n = random.integer(2, 12);
    OwnedProblem problem({n, 0, 96});
    problem.H.setIdentity();
    for (int i = 0; i < n; ++i) problem.g[i] = random.integer(-3, 3);
    for (int i = 0; i < 96; ++i) {
      for (int j = 0; j < n; ++j) problem.C(i, j) = random.integer(-1, 1);
    }
    problem.u.setZero();
    problem.lb.setConstant(-1.0);
    solve_and_judge(&solver, problem);
  }
}

TEST(Degenerate, EveryRowTwiceAndOncemoreAsItsNegative) {
  DenseSolver solver(kMax);
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    RandomProblemSpec spec;
    spec.size = {random.integer(10, 60), random.integer(0, 10), 30};
    spec.active_fraction = random.uniform(0.0, 1.0);
    const auto known = make_random_problem(spec, &random);
    OwnedProblem problem = known.problem;
    problem.C.resize(90, spec.size.unknowns);
    problem.C << known.problem.C, known.problem.C, -2.0 * known.problem.C;
    problem.l.resize(90);
    problem.l << known.problem.l, known.problem.l, -2.0 * known.problem.u;
    problem.u.resize(90);
    problem.u << known.problem.u, known.problem.u, -2.0 * known.problem.l;
    const Result result = solve_and_judge(&solver, problem);
    EXPECT_LE((to_vector(result.x) - known.x).cwiseAbs().maxCoeff(), 1e-6) << seed;
  }
}

TEST(Degenerate, RowsThatAreAlmostParallel) {
  DenseSolver solver(kMax);
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    const int n = random.integer(5, 40);
    const double angle = std::pow(10.0, random.uniform(-13.0, -3.0));
    OwnedProblem problem({n, 0, 60});
    problem.H.setIdentity();
    problem.g = random.vector(n) * 5.0;
    const Eigen::MatrixXd base = random.matrix(6, n);
    for (int i = 0; i < 60; ++i) {
      problem.C.row(i) = base.row(i % 6) + angle * random.matrix(1, n);
      problem.u[i] = 0.1 + angle * random.uniform(0.0, 1.0);
    }
    solve_and_judge(&solver, problem);
  }
}

TEST(Degenerate, RedundantEqualitiesAreDropped) {
  DenseSolver solver(kMax);
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    RandomProblemSpec spec;
    spec.size = {random.integer(20, 80), 10, 30};
    spec.active_fraction = random.uniform(0.0, 1.0);
    const auto known = make_random_problem(spec, &random);
    OwnedProblem problem = known.problem;
    const Eigen::MatrixXd mix = random.matrix(15, 10);
    problem.A.resize(25, spec.size.unknowns);
    problem.A << mix * known.problem.A, known.problem.A;
    problem.b.resize(25);
    problem.b << mix * known.problem.b, known.problem.b;
    const Result result = solve_and_judge(&solver, problem);
    EXPECT_LE((to_vector(result.x) - known.x).cwiseAbs().maxCoeff(), 1e-6) << seed;
  }
}

TEST(Degenerate, EqualSidesAreEqualities) {
  DenseSolver solver(kMax);
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    RandomProblemSpec spec;
    spec.size = {random.integer(20, 80), 5, 30};
    auto known = make_random_problem(spec, &random);
    OwnedProblem& problem = known.problem;
    const Eigen::VectorXd cx = problem.C * known.x;
    for (int i = 0; i < 4; ++i) problem.l[i] = problem.u[i] = cx[i];
    for (int i = 0; i < 4; ++i) problem.lb[i] = problem.ub[i] = known.x[i];
    const Result result = solve_and_judge(&solver, problem);
    EXPECT_EQ(result.active.bounds[0], Side::none);
    for (int i = 0; i < 4; ++i) EXPECT_EQ(result.x[i], known.x[i]);
    EXPECT_LE((to_vector(result.x) - known.x).cwiseAbs().maxCoeff(), 1e-6) << seed;
  }
}

TEST(Degenerate, EverythingFixed) {
  OwnedProblem problem({30, 3, 5});
  Random random(1);
  problem.H.setIdentity();
  problem.lb = problem.ub = random.vector(30);
  problem.A = random.matrix(3, 30);
  problem.b = problem.A * problem.lb;
  problem.C = random.matrix(5, 30);
  problem.l = problem.u = problem.C * problem.lb;
  DenseSolver solver(kMax);
  const Result result = solve_and_judge(&solver, problem);
  EXPECT_EQ(to_vector(result.x), problem.lb);
}

TEST(Degenerate, BadlyScaledUnknownsAndRows) {
  DenseSolver solver(kMax);
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    Random random(seed);
    RandomProblemSpec spec;
    spec.size = {random.integer(5, 70), 5, 30};
    spec.active_fraction = random.uniform(0.0, 1.0);
    const auto known = make_random_problem(spec, &random);
    OwnedProblem problem = known.problem;
    const double decades = random.uniform(0.0, 4.0);
    for (int i = 0; i < spec.size.unknowns; ++i) {
      const double s = std::pow(10.0, random.uniform(-decades, decades));
      problem.H.row(i) *= s;
      problem.H.col(i) *= s;
      problem.g[i] *= s;
      problem.A.col(i) *= s;
      problem.C.col(i) *= s;
      problem.lb[i] /= s;
      problem.ub[i] /= s;
    }
    for (int i = 0; i < 30; ++i) {
      const double s = std::pow(10.0, random.uniform(-decades, decades));
      problem.C.row(i) *= s;
      problem.l[i] *= s;
      problem.u[i] *= s;
    }
    solve_and_judge(&solver, problem);
  }
}

// Klee & Minty (1972): exponentially many vertices for the simplex method.
TEST(Degenerate, KleeMintyCubeIsNoTrouble) {
  const int n = 10;
  OwnedProblem problem({n, 0, n});
  for (int i = 0; i < n; ++i) {
    problem.H(i, i) = 1e-3;
    problem.g[i] = -std::pow(2.0, n - 1 - i);
    for (int j = 0; j < i; ++j) problem.C(i, j) = std::pow(2.0, i - j + 1);
    problem.C(i, i) = 1.0;
    problem.u[i] = std::pow(5.0, i + 1);
    problem.lb[i] = 0.0;
  }
  DenseSolver solver(kMax);
  solve_and_judge(&solver, problem);
}

}  // namespace
}  // namespace gaitd::qp
