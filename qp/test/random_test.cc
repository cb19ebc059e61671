// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "random_problem.h"

namespace gaitd::qp {
namespace {

using testing::kMax;

using testing::HessianKind;
using testing::make_random_problem;
using testing::Random;
using testing::RandomProblemSpec;
using testing::SolvedProblem;
using testing::to_vector;

RandomProblemSpec draw_spec(Random* random) {
  RandomProblemSpec spec;
  const int n = random->integer(45, 80);
  const int p = random->chance(0.7) ? 6 : random->integer(7, 40);
  spec.size = {n, p, random->integer(0, 60)};
  spec.hessian = static_cast<HessianKind>(random->integer(0, 2));
  spec.active_fraction = random->uniform(0.0, 1.0);
  return spec;
}

TEST(RandomProblems, TenThousandReachTheKktPoint) {
  DenseSolver solver(kMax);
  Options cold;
  cold.warm_start = false;
  double worst = 0.0;
  double farthest = 0.0;
  for (std::uint64_t seed = 0; seed < 10000; ++seed) {
    Random random(seed);
    const SolvedProblem known = make_random_problem(draw_spec(&random), &random);
    const Problem problem = known.problem.view();
    const Result result = solver.solve(problem, cold);
    ASSERT_EQ(result.status, Status::solved) << "seed " << seed;
    const KktResiduals residuals = testing::judge(problem, result);
    worst = std::max({worst, residuals.absolute.max(), residuals.scaled.max()});
    ASSERT_LE(worst, 1e-8) << "seed " << seed;
    farthest = std::max(farthest, (to_vector(result.x) - known.x).cwiseAbs().maxCoeff());
    ASSERT_LE(farthest, 1e-6) << "seed " << seed;
  }
  RecordProperty("worst_residual", std::to_string(worst));
  EXPECT_LE(worst, 1e-9);
}

// Perturbs a problem like the next tick of a controller would.
void drift(SolvedProblem* known, Random* random) {
  auto& p = known->problem;
  p.g += 0.05 * random->vector(static_cast<int>(p.g.size()));
  p.C += 0.002 * random->matrix(static_cast<int>(p.C.rows()), static_cast<int>(p.C.cols()));
  const Eigen::VectorXd inside = known->x;
  const Eigen::VectorXd cx = p.C * inside;
  p.l = p.l.cwiseMin(cx);
  p.u = p.u.cwiseMax(cx);
}

TEST(RandomProblems, WarmStartedSequencesGiveTheColdAnswerFaster) {
  DenseSolver warm(kMax);
  DenseSolver cold(kMax);
  Options no_warm_start;
  no_warm_start.warm_start = false;
  long warm_iterations = 0;
  long cold_iterations = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(1000000 + seed);
    SolvedProblem known = make_random_problem(draw_spec(&random), &random);
    for (int tick = 0; tick < 25; ++tick) {
      const Problem problem = known.problem.view();
      const Result a = warm.solve(problem);
      const Result b = cold.solve(problem, no_warm_start);
      ASSERT_TRUE(a.solved()) << "seed " << seed << " tick " << tick;
      ASSERT_TRUE(b.solved()) << "seed " << seed << " tick " << tick;
      ASSERT_LE(testing::judge(problem, a).absolute.max(), 1e-8);
      ASSERT_LE((to_vector(a.x) - to_vector(b.x)).cwiseAbs().maxCoeff(), 1e-8);
      warm_iterations += a.iterations;
      cold_iterations += b.iterations;
      drift(&known, &random);
    }
  }
  EXPECT_LT(3 * warm_iterations, cold_iterations);
}

TEST(RandomProblems, AnyGuessLeadsToTheSameAnswer) {
  DenseSolver solver(kMax);
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(2000000 + seed);
    const SolvedProblem known = make_random_problem(draw_spec(&random), &random);
    const Problem problem = known.problem.view();
    std::vector<Side> rows(random.integer(0, kMax.inequalities));
    std::vector<Side> bounds(random.integer(0, kMax.unknowns));
    for (auto* sides : {&rows, &bounds}) {
      for (Side& side : *sides) side = static_cast<Side>(random.integer(-1, 1));
    }
    Options options;
    options.guess = {rows, bounds};
    const Result result = solver.solve(problem, options);
    ASSERT_TRUE(result.solved()) << "seed " << seed;
    ASSERT_LE((to_vector(result.x) - known.x).cwiseAbs().maxCoeff(), 1e-7) << "seed " << seed;
  }
}

TEST(RandomProblems, TheRightGuessNeedsNoIteration) {
  DenseSolver solver(kMax);
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(3000000 + seed);
    const SolvedProblem known = make_random_problem(draw_spec(&random), &random);
    Options cold;
    cold.warm_start = false;
    const Result first = solver.solve(known.problem.view(), cold);
    const std::vector<Side> rows(first.active.inequalities.begin(),
                                 first.active.inequalities.end());
    const std::vector<Side> bounds(first.active.bounds.begin(), first.active.bounds.end());
    solver.reset_warm_start();
    Options options;
    options.guess = {rows, bounds};
    const Result second = solver.solve(known.problem.view(), options);
    ASSERT_TRUE(second.solved());
    EXPECT_EQ(second.iterations, 0) << "seed " << seed;
  }
}

TEST(RandomProblems, SizesMayChangeBetweenWarmStarts) {
  DenseSolver solver(kMax);
  Random random(4);
  for (int k = 0; k < 500; ++k) {
    RandomProblemSpec spec;
    spec.size = {random.integer(1, 112), 0, random.integer(0, 96)};
    spec.size.equalities = random.integer(0, std::min(40, spec.size.unknowns));
    spec.active_fraction = random.uniform(0.0, 1.0);
    const SolvedProblem known = make_random_problem(spec, &random);
    const Result result = solver.solve(known.problem.view());
    ASSERT_TRUE(result.solved()) << k;
    ASSERT_LE(testing::judge(known.problem.view(), result).scaled.max(), 1e-8) << k;
  }
}

}  // namespace
}  // namespace gaitd::qp
