// SPDX-License-Identifier: Apache-2.0
#include "null_space_projector.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

namespace gaitd::plugins {
namespace {

Eigen::MatrixXd matrix(const NullSpaceProjector& projector, int n) {
  Eigen::MatrixXd N(n, n);
  Eigen::VectorXd row(n);
  for (int i = 0; i < n; ++i) {
    projector.row(i, row);
    N.row(i) = row;
  }
  return N;
}

TEST(NullSpaceProjector, TasksDoNotFeelWhatItLetsThrough) {
  srand(3);
  const int n = 12, m = 7;
  const Eigen::MatrixXd J = Eigen::MatrixXd::Random(m, n);
  NullSpaceProjector projector(n, 20);
  projector.clear();
  for (int i = 0; i < m; ++i) projector.add((i + 1) * J.row(i));  // lengths do not matter
  projector.compute(1e-5);
  const Eigen::MatrixXd N = matrix(projector, n);
  EXPECT_LT((J * N).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT((N - N.transpose()).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT((N * N - N).cwiseAbs().maxCoeff(), 1e-7);
  EXPECT_NEAR(projector.trace(), n - m, 1e-6);
  EXPECT_NEAR(N.trace(), projector.trace(), 1e-9);
}

// What serves the tasks with the least sum of (x / ease)^2 is not let through.
TEST(NullSpaceProjector, TasksAreLeftToWhatMovesWithEase) {
  srand(6);
  const int n = 9, m = 3;
  const Eigen::MatrixXd J = Eigen::MatrixXd::Random(m, n);
  Eigen::VectorXd ease = Eigen::VectorXd::Ones(n);
  ease.segment(4, 3).setConstant(1.5);
  NullSpaceProjector projector(n, 20);
  projector.clear();
  for (int i = 0; i < m; ++i) projector.add(J.row(i));
  for (int c = 0; c < n; ++c) projector.ease(c, ease[c]);
  projector.compute(1e-6);
  const Eigen::MatrixXd N = matrix(projector, n);
  EXPECT_LT((J * N).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT((N * N - N).cwiseAbs().maxCoeff(), 1e-7);
  EXPECT_NEAR(N.trace(), projector.trace(), 1e-9);
  const Eigen::MatrixXd D2 = ease.cwiseAbs2().asDiagonal();
  const Eigen::VectorXd x =
      D2 * J.transpose() * (J * D2 * J.transpose()).ldlt().solve(Eigen::Vector3d(1.0, -2.0, 0.5));
  EXPECT_LT((N * x).cwiseAbs().maxCoeff(), 1e-7);
  projector.clear();  // as it was
  for (int i = 0; i < m; ++i) projector.add(J.row(i));
  projector.compute(1e-6);
  EXPECT_GT((matrix(projector, n) * x).norm(), 1e-2);
}

TEST(NullSpaceProjector, DependentRowsClaimOnce) {
  srand(4);
  const int n = 8;
  const Eigen::MatrixXd J = Eigen::MatrixXd::Random(3, n);
  NullSpaceProjector projector(n, 20);
  projector.clear();
  for (int i = 0; i < 3; ++i) projector.add(J.row(i));
  projector.add(J.row(0) + J.row(1));
  projector.add(Eigen::RowVectorXd::Zero(n));
  projector.compute(1e-5);
  EXPECT_NEAR(projector.trace(), n - 3, 1e-4);
}

TEST(NullSpaceProjector, ClaimedColumnsAreNotFree) {
  srand(5);
  const int n = 10;
  const Eigen::MatrixXd J = Eigen::MatrixXd::Random(4, n);
  NullSpaceProjector projector(n, 20);
  projector.clear();
  for (int i = 0; i < 4; ++i) projector.add(J.row(i));
  for (int c : {1, 6}) projector.claim(c);
  projector.compute(1e-5);
  const Eigen::MatrixXd N = matrix(projector, n);
  EXPECT_NEAR(projector.trace(), n - 2 - 4, 1e-6);
  EXPECT_EQ(N.row(1).norm(), 0.0);
  EXPECT_EQ(N.col(6).norm(), 0.0);
  EXPECT_LT((J * N).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(NullSpaceProjector, DampingBoundsANearlyDependentTask) {
  // Two rows a thousandth apart: without damping the projector would turn with their difference.
  Eigen::MatrixXd J(2, 3);
  J << 1, 0, 0, 1, 1e-4, 0;
  NullSpaceProjector projector(3, 8);
  projector.clear();
  for (int i = 0; i < 2; ++i) projector.add(J.row(i));
  projector.compute(0.005);
  EXPECT_GT(projector.trace(), 1.9);
  EXPECT_TRUE(matrix(projector, 3).allFinite());
}

}  // namespace
}  // namespace gaitd::plugins
