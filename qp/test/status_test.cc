// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
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

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

OwnedProblem small_problem() {
  OwnedProblem problem({4, 1, 2});
  problem.H.setIdentity();
  problem.g << 1.0, -2.0, 0.5, 0.0;
  problem.A << 1.0, 1.0, 0.0, 0.0;
  problem.b << 1.0;
  problem.C << 1.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 1.0;
  problem.l.setConstant(-1.0);
  problem.u.setConstant(1.0);
  problem.lb.setConstant(-5.0);
  problem.ub.setConstant(5.0);
  return problem;
}

Status status_of(const OwnedProblem& problem) {
  DenseSolver solver(kMax);
  return solver.solve(problem.view()).status;
}

TEST(Status, InfeasibleBounds) {
  OwnedProblem problem = small_problem();
  problem.lb[2] = 6.0;
  EXPECT_EQ(status_of(problem), Status::infeasible);
  problem = small_problem();
  problem.l[1] = 1.5;
  EXPECT_EQ(status_of(problem), Status::infeasible);
  problem = small_problem();
  problem.lb[0] = kInfinity;
  problem.ub[0] = kInfinity;
  EXPECT_EQ(status_of(problem), Status::infeasible);
}

TEST(Status, ContradictingEqualities) {
  OwnedProblem problem({4, 3, 0});
  problem.H.setIdentity();
  problem.A << 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 1.0, 2.0, 1.0, 0.0;
  problem.b << 1.0, 2.0, 3.0;
  EXPECT_EQ(status_of(problem), Status::solved);
  problem.b[2] = 3.001;
  EXPECT_EQ(status_of(problem), Status::infeasible);
}

TEST(Status, ZeroRows) {
  OwnedProblem problem = small_problem();
  problem.A.setZero();
  EXPECT_EQ(status_of(problem), Status::infeasible);
  problem.b.setZero();
  EXPECT_EQ(status_of(problem), Status::solved);
  problem.C.setZero();
  EXPECT_EQ(status_of(problem), Status::solved);
  problem.l[0] = 0.5;
  EXPECT_EQ(status_of(problem), Status::infeasible);
}

TEST(Status, InequalitiesAgainstBoundsAndEqualities) {
  OwnedProblem problem = small_problem();
  problem.C.row(0).setOnes();
  problem.l[0] = 20.1;
  problem.u[0] = 30.0;
  EXPECT_EQ(status_of(problem), Status::infeasible);
  problem = small_problem();
  problem.C.row(0) = 2.0 * problem.A.row(0);
  problem.l[0] = 2.5;
  problem.u[0] = 3.0;
  EXPECT_EQ(status_of(problem), Status::infeasible);
  problem.l[0] = 2.0;
  EXPECT_EQ(status_of(problem), Status::solved);
}

TEST(Status, RandomInfeasibleProblemsAreFoundOut) {
  DenseSolver solver(kMax);
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    Random random(seed);
    RandomProblemSpec spec;
    spec.size = {random.integer(5, 70), 3, random.integer(10, 60)};
    spec.rank = random.chance(0.5) ? -1 : random.integer(0, spec.size.unknowns);
    spec.active_fraction = random.uniform(0.0, 1.0);
    auto known = make_random_problem(spec, &random);
    // Farkas: a non-negative combination of some rows is bounded from above, ask for more.
    OwnedProblem& problem = known.problem;
    const int m = spec.size.inequalities;
    const int rows = random.integer(1, std::min(m - 1, spec.size.unknowns - 1));
    Eigen::VectorXd weights = random.vector(rows).cwiseAbs();
    weights.array() += 0.1;
    problem.C.row(m - 1) = weights.transpose() * problem.C.topRows(rows);
    problem.u.head(rows) = problem.C.topRows(rows) * known.x + random.vector(rows).cwiseAbs();
    problem.l[m - 1] = weights.dot(problem.u.head(rows)) + random.uniform(0.001, 1.0);
    problem.u[m - 1] = kInfinity;
    ASSERT_EQ(solver.solve(problem.view()).status, Status::infeasible) << "seed " << seed;
  }
}

TEST(Status, NonFiniteDataIsRefused) {
  for (double bad : {kNan, kInfinity, -kInfinity}) {
    for (auto member : {&OwnedProblem::H, &OwnedProblem::A, &OwnedProblem::C}) {
      OwnedProblem problem = small_problem();
      (problem.*member)(0, 0) = bad;
      EXPECT_EQ(status_of(problem), Status::non_finite);
    }
    for (auto member : {&OwnedProblem::g, &OwnedProblem::b}) {
      OwnedProblem problem = small_problem();
      (problem.*member)[0] = bad;
      EXPECT_EQ(status_of(problem), Status::non_finite);
    }
  }
  for (auto member : {&OwnedProblem::l, &OwnedProblem::u, &OwnedProblem::lb, &OwnedProblem::ub}) {
    OwnedProblem problem = small_problem();
    (problem.*member)[1] = kNan;
    EXPECT_EQ(status_of(problem), Status::non_finite);
  }
  OwnedProblem problem = small_problem();
  problem.H(3, 3) = kNan;
  EXPECT_EQ(status_of(problem), Status::non_finite);
}

TEST(Status, UpperTriangleOfTheHessianIsNotRead) {
  OwnedProblem problem = small_problem();
  problem.H(0, 3) = kNan;
  problem.H(1, 2) = 1e9;
  EXPECT_EQ(status_of(problem), Status::solved);
}

TEST(Status, SizesThatDoNotFitAreRefused) {
  OwnedProblem problem = small_problem();
  problem.A.resize(1, 3);
  EXPECT_EQ(status_of(problem), Status::invalid_dimensions);
  problem = small_problem();
  problem.l.resize(1);
  EXPECT_EQ(status_of(problem), Status::invalid_dimensions);
  DenseSolver small({3, 1, 2});
  const Result result = small.solve(small_problem().view());
  EXPECT_EQ(result.status, Status::invalid_dimensions);
  EXPECT_EQ(result.x.size(), 0);
  EXPECT_EQ(result.residuals.scaled.max(), kInfinity);
  EXPECT_EQ(small.solve(Problem{}).status, Status::invalid_dimensions);
}

TEST(Status, SolverRecoversAfterEveryFailure) {
  DenseSolver solver(kMax);
  const OwnedProblem good = small_problem();
  OwnedProblem bad = small_problem();
  const Result before = solver.solve(good.view());
  const Eigen::VectorXd expected = testing::to_vector(before.x);
  for (int kind = 0; kind < 4; ++kind) {
    bad = small_problem();
    if (kind == 0) bad.H(0, 0) = kNan;
    if (kind == 1) bad.lb[0] = 6.0;
    if (kind == 2) bad.H(0, 0) = -1.0;
    if (kind == 3) bad.g[0] = 1e308;
    EXPECT_FALSE(solver.solve(bad.view()).status == Status::solved && kind < 3);
    const Result after = solver.solve(good.view());
    ASSERT_TRUE(after.solved());
    EXPECT_LE((testing::to_vector(after.x) - expected).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(Status, IterationCapIsKeptAndReported) {
  DenseSolver solver(kMax);
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    RandomProblemSpec spec;
    spec.size = {60, 6, 30};
    spec.active_fraction = 0.5;
    const auto known = make_random_problem(spec, &random);
    Options options;
    options.warm_start = false;
    options.max_iterations = 1;
    const Result result = solver.solve(known.problem.view(), options);
    EXPECT_EQ(result.status, Status::max_iterations);
    EXPECT_EQ(result.iterations, 1);
    EXPECT_TRUE(testing::to_vector(result.x).allFinite());
    EXPECT_GT(testing::judge(known.problem.view(), result).scaled.max(), 1e-8);
  }
}

TEST(Status, RepeatedCapsOfOneStillArriveByWarmStart) {
  DenseSolver solver(kMax);
  Random random(9);
  RandomProblemSpec spec;
  spec.size = {60, 6, 30};
  const auto known = make_random_problem(spec, &random);
  Options options;
  options.max_iterations = 3;
  int calls = 0;
  while (calls < 200 && !solver.solve(known.problem.view(), options).solved()) ++calls;
  EXPECT_LT(calls, 200);
  EXPECT_GT(calls, 1);
}

TEST(Status, SmallestProblems) {
  DenseSolver solver({1, 0, 0});
  const Eigen::MatrixXd h = Eigen::MatrixXd::Constant(1, 1, 2.0);
  const Eigen::VectorXd g = Eigen::VectorXd::Constant(1, -4.0);
  const Eigen::VectorXd ub = Eigen::VectorXd::Constant(1, 1.5);
  Problem problem;
  problem.H = h;
  problem.g = g;
  Result result = solver.solve(problem);
  ASSERT_TRUE(result.solved());
  EXPECT_DOUBLE_EQ(result.x[0], 2.0);
  EXPECT_DOUBLE_EQ(result.objective, -4.0);
  problem.ub = ub;
  result = solver.solve(problem);
  ASSERT_TRUE(result.solved());
  EXPECT_EQ(result.x[0], 1.5);
  EXPECT_NEAR(result.w[0], 1.0, 1e-14);
  EXPECT_EQ(result.active.bounds[0], Side::upper);
}

TEST(Status, PartsMayBeLeftOut) {
  DenseSolver solver(kMax);
  OwnedProblem owned = small_problem();
  Problem problem = owned.view();
  problem.A = {};
  problem.b = {};
  EXPECT_TRUE(solver.solve(problem).solved());
  problem.C = {};
  problem.l = {};
  problem.u = {};
  EXPECT_TRUE(solver.solve(problem).solved());
  problem.lb = {};
  const Result result = solver.solve(problem);
  EXPECT_TRUE(result.solved());
  EXPECT_DOUBLE_EQ(result.x[1], 2.0);
}

}  // namespace
}  // namespace gaitd::qp
