// SPDX-License-Identifier: Apache-2.0
#include "gaitd/qp/kkt.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "random_problem.h"

namespace gaitd::qp {
namespace {

using testing::make_random_problem;
using testing::OwnedProblem;
using testing::Random;
using testing::RandomProblemSpec;

// min ½(x₀² + x₁²) s.t. x₀ + x₁ = 2, 0.5 ≤ x₁ − x₀, x ≤ 10: x = (0.75, 1.25), y = −1, z = −0.25.
struct Example {
  OwnedProblem problem{{2, 1, 1}};
  Eigen::VectorXd x{{0.75, 1.25}};
  Eigen::VectorXd y{{-1.0}};
  Eigen::VectorXd z{{-0.25}};
  Eigen::VectorXd w{{0.0, 0.0}};

  Example() {
    problem.H.setIdentity();
    problem.A << 1.0, 1.0;
    problem.b << 2.0;
    problem.C << -1.0, 1.0;
    problem.l << 0.5;
    problem.ub.setConstant(10.0);
  }
  KktNorms absolute() {
    KktJudge judge({2, 1, 1});
    return judge.evaluate(problem.view(), {x, y, z, w}).absolute;
  }
};

TEST(Kkt, OptimalPointHasNoResidual) {
  Example example;
  EXPECT_EQ(example.absolute().max(), 0.0);
}

TEST(Kkt, EachConditionIsSeenByItsOwnFigure) {
  Example example;
  example.y[0] += 0.3;
  EXPECT_NEAR(example.absolute().stationarity, 0.3, 1e-15);

  example = Example();
  example.problem.b[0] = 2.2;
  EXPECT_NEAR(example.absolute().primal_equality, 0.2, 1e-15);

  example = Example();
  example.problem.l[0] = 0.6;
  EXPECT_NEAR(example.absolute().primal_inequality, 0.1, 1e-15);
  EXPECT_NEAR(example.absolute().complementarity, 0.025, 1e-15);

  example = Example();
  example.problem.ub[1] = 1.0;
  EXPECT_NEAR(example.absolute().primal_inequality, 0.25, 1e-15);

  example = Example();
  example.z[0] = 0.25;
  EXPECT_EQ(example.absolute().dual_sign, 0.25);

  example = Example();
  example.w[0] = 2.0;
  EXPECT_NEAR(example.absolute().complementarity, 2.0 * 9.25, 1e-14);
}

TEST(Kkt, NanIsNeverSwallowed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int kind = 0; kind < 6; ++kind) {
    Example example;
    if (kind == 0) example.x[0] = nan;
    if (kind == 1) example.y[0] = nan;
    if (kind == 2) example.z[0] = nan;
    if (kind == 3) example.w[1] = nan;
    if (kind == 4) example.problem.H(1, 0) = nan;
    if (kind == 5) example.problem.b[0] = nan;
    KktJudge judge({2, 1, 1});
    const KktResiduals r =
        judge.evaluate(example.problem.view(), {example.x, example.y, example.z, example.w});
    EXPECT_FALSE(r.scaled.max() <= 1.0) << kind;
    EXPECT_TRUE(std::isnan(r.absolute.max())) << kind;
  }
}

TEST(Kkt, AgreesWithTheTextbookFormula) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    RandomProblemSpec spec;
    spec.size = {random.integer(1, 50), random.integer(0, 9), random.integer(0, 20)};
    const auto known = make_random_problem(spec, &random);
    const OwnedProblem& p = known.problem;
    const auto [n, neq, nineq] = spec.size;
    const Eigen::VectorXd x = random.vector(n);
    const Eigen::VectorXd y = random.vector(neq);
    const Eigen::VectorXd z = random.vector(nineq);
    const Eigen::VectorXd w = random.vector(n);
    KktJudge judge({60, 10, 20});
    const KktNorms norms = judge.evaluate(p.view(), {x, y, z, w}).absolute;

    const Eigen::VectorXd gradient = p.H * x + p.g + p.A.transpose() * y + p.C.transpose() * z + w;
    EXPECT_NEAR(norms.stationarity, gradient.cwiseAbs().maxCoeff(), 1e-11);
    EXPECT_NEAR((judge.stationarity().head(n) - gradient).cwiseAbs().maxCoeff(), 0.0, 1e-11);
    EXPECT_NEAR(judge.objective(), 0.5 * x.dot(p.H * x) + p.g.dot(x), 1e-10);
    if (neq > 0) {
      EXPECT_NEAR(norms.primal_equality, (p.A * x - p.b).cwiseAbs().maxCoeff(), 1e-12);
    }
    const Eigen::VectorXd cx = p.C * x;
    double excess = 0.0;
    for (int i = 0; i < nineq; ++i) {
      excess = std::max({excess, p.l[i] - cx[i], cx[i] - p.u[i]});
    }
    for (int i = 0; i < n; ++i) excess = std::max({excess, p.lb[i] - x[i], x[i] - p.ub[i]});
    EXPECT_NEAR(norms.primal_inequality, excess, 1e-12);
  }
}

TEST(Kkt, ScaledFiguresDoNotDependOnTheUnitOfTheCost) {
  Example example;
  example.x[0] += 1e-3;
  KktJudge judge({2, 1, 1});
  example.problem.H *= 1e9;
  example.y *= 1e9;
  example.z *= 1e9;
  const KktResiduals r =
      judge.evaluate(example.problem.view(), {example.x, example.y, example.z, example.w});
  EXPECT_GT(r.absolute.stationarity, 1e5);
  EXPECT_LT(r.scaled.stationarity, 2e-3);
  EXPECT_LT(r.scaled.complementarity, 2e-3);
}

}  // namespace
}  // namespace gaitd::qp
