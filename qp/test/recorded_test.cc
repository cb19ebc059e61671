// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "random_problem.h"
#include "recorded_problems.h"

namespace gaitd::qp {
namespace {

using testing::kMax;

using testing::read_recorded;
using testing::RecordedProblem;
using testing::to_vector;

class Recorded : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    sequence_ = read_recorded(GetParam());
    ASSERT_EQ(sequence_.size(), 30u);
  }
  std::vector<RecordedProblem> sequence_;
};

TEST_P(Recorded, ReachesTheReferenceSolution) {
  for (bool warm : {true, false}) {
    DenseSolver solver(kMax);
    Options options;
    options.warm_start = warm;
    for (const RecordedProblem& recorded : sequence_) {
      const Problem problem = recorded.problem.view();
      const Result result = solver.solve(problem, options);
      ASSERT_EQ(result.status, Status::solved);
      ASSERT_LE(testing::judge(problem, result).absolute.max(), 1e-9);
      const Eigen::VectorXd x = to_vector(result.x);
      const double scale = 1.0 + recorded.reference.cwiseAbs().maxCoeff();
      ASSERT_LE((x - recorded.reference).cwiseAbs().maxCoeff(), 1e-9 * scale);
    }
  }
}

TEST_P(Recorded, WarmStartNeedsFewChangesPerTick) {
  DenseSolver solver(kMax);
  int iterations = 0;
  solver.solve(sequence_[0].problem.view());
  for (const RecordedProblem& recorded : sequence_) {
    iterations += solver.solve(recorded.problem.view()).iterations;
  }
  EXPECT_LT(iterations, 2 * static_cast<int>(sequence_.size()));
}

TEST_P(Recorded, TightTorqueLimitsAndLeastForcesBecomeActive) {
  DenseSolver warm(kMax);
  DenseSolver cold(kMax);
  Options no_warm_start;
  no_warm_start.warm_start = false;
  int active_rows = 0;
  for (RecordedProblem& recorded : sequence_) {
    testing::tighten(&recorded);
    const auto& problem = recorded.problem;
    const Result a = warm.solve(problem.view());
    const Result b = cold.solve(problem.view(), no_warm_start);
    ASSERT_EQ(a.status, Status::solved);
    ASSERT_EQ(b.status, Status::solved);
    ASSERT_LE(testing::judge(problem.view(), a).absolute.max(), 1e-8);
    const double scale = 1.0 + to_vector(b.x).cwiseAbs().maxCoeff();
    ASSERT_LE((to_vector(a.x) - to_vector(b.x)).cwiseAbs().maxCoeff(), 1e-9 * scale);
    for (Side side : a.active.inequalities) active_rows += side != Side::none;
  }
  EXPECT_GE(active_rows, 3 * static_cast<int>(sequence_.size()));
}

// A contact switch: the sequences follow each other in one solver.
TEST(RecordedSwitch, SequencesOfDifferentSizesShareOneSolver) {
  DenseSolver solver(kMax);
  for (int round = 0; round < 2; ++round) {
    for (const char* name : testing::kRecordedSequences) {
      for (const RecordedProblem& recorded : read_recorded(name)) {
        const Result result = solver.solve(recorded.problem.view());
        ASSERT_TRUE(result.solved());
        const double scale = 1.0 + recorded.reference.cwiseAbs().maxCoeff();
        ASSERT_LE((to_vector(result.x) - recorded.reference).cwiseAbs().maxCoeff(), 1e-9 * scale);
      }
    }
  }
}

TEST(RecordedSwitch, MissingFileReadsAsEmpty) { EXPECT_TRUE(read_recorded("nothing").empty()); }

INSTANTIATE_TEST_SUITE_P(Sequences, Recorded, ::testing::ValuesIn(testing::kRecordedSequences),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace gaitd::qp
