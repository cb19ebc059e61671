// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "random_problem.h"

namespace gaitd::qp {
namespace {

using testing::kMax;

using testing::make_random_problem;
using testing::OwnedProblem;
using testing::Random;
using testing::RandomProblemSpec;

std::vector<double> everything(const Result& result) {
  std::vector<double> all = {static_cast<double>(result.iterations), result.objective,
                             result.residuals.absolute.max(), result.residuals.scaled.max()};
  for (const VectorView& v : {result.x, result.y, result.z, result.w}) {
    all.insert(all.end(), v.data(), v.data() + v.size());
  }
  return all;
}

std::vector<OwnedProblem> sequence() {
  std::vector<OwnedProblem> problems;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    RandomProblemSpec spec;
    spec.size = {random.integer(20, 90), random.integer(0, 8), random.integer(0, 60)};
    spec.rank = random.chance(0.3) ? random.integer(0, spec.size.unknowns) : -1;
    problems.push_back(make_random_problem(spec, &random).problem);
  }
  return problems;
}

bool identical(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), 8 * a.size()) == 0;
}

TEST(Determinism, SameHistoryGivesTheSameBits) {
  const std::vector<OwnedProblem> problems = sequence();
  DenseSolver first(kMax);
  DenseSolver second(kMax);
  for (const OwnedProblem& problem : problems) {
    const std::vector<double> a = everything(first.solve(problem.view()));
    EXPECT_TRUE(identical(a, everything(second.solve(problem.view()))));
  }
}

TEST(Determinism, ResetForgetsThePast) {
  const std::vector<OwnedProblem> problems = sequence();
  DenseSolver used(kMax);
  for (const OwnedProblem& problem : problems) {
    used.reset_warm_start();
    const std::vector<double> a = everything(used.solve(problem.view()));
    DenseSolver fresh(kMax);
    EXPECT_TRUE(identical(a, everything(fresh.solve(problem.view()))));
  }
}

// A replay finds its data at other addresses and may give the solver other maxima.
TEST(Determinism, NeitherAlignmentNorMaximaMatter) {
  for (const OwnedProblem& owned : sequence()) {
    DenseSolver wide(kMax);
    DenseSolver tight(owned.view().dimensions());
    const std::vector<double> a = everything(wide.solve(owned.view()));
    Problem shifted = owned.view();
    const int n = shifted.g.size();
    Eigen::MatrixXd h = Eigen::MatrixXd::Constant(n + 3, n, 7.0);
    h.middleRows(1, n) = owned.H;
    Eigen::MatrixXd c = Eigen::MatrixXd::Constant(owned.C.rows() + 1, n, 7.0);
    c.bottomRows(owned.C.rows()) = owned.C;
    Eigen::VectorXd g(n + 1);
    g.tail(n) = owned.g;
    shifted.H = h.middleRows(1, n);
    shifted.C = c.bottomRows(owned.C.rows());
    shifted.g = g.tail(n);
    EXPECT_TRUE(identical(a, everything(tight.solve(shifted))));
  }
}

}  // namespace
}  // namespace gaitd::qp
