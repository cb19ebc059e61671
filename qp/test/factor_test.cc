// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "block_cholesky.h"
#include "kernels.h"
#include "random_problem.h"
#include "thin_qr.h"

namespace gaitd::qp {
namespace {

using testing::Random;

Eigen::MatrixXd random_spd(int n, Random* random) {
  const Eigen::MatrixXd a = random->matrix(n, n);
  return a.transpose() * a + 0.1 * Eigen::MatrixXd::Identity(n, n);
}

Eigen::VectorXd pad(const Eigen::VectorXd& v) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(kernels::padded(static_cast<int>(v.size())) + 4);
  result.head(v.size()) = v;
  return result;
}

void check_against_eigen(const BlockCholesky& factor, const Eigen::MatrixXd& h, Random* random) {
  const int n = static_cast<int>(h.rows());
  const Eigen::MatrixXd l = h.llt().matrixL();
  const Eigen::VectorXd v = random->vector(n);
  Eigen::VectorXd out = Eigen::VectorXd::Constant(kernels::padded(n) + 4, 9.0);
  factor.apply(pad(v).data(), out.data());
  EXPECT_LE((l * out.head(n) - v).norm(), 1e-11 * (1.0 + out.norm()));
  EXPECT_EQ(out.tail(out.size() - n).norm(), 0.0);
  out.setConstant(9.0);
  factor.apply_transposed(pad(v).data(), out.data());
  EXPECT_LE((l.transpose() * out.head(n) - v).norm(), 1e-11 * (1.0 + out.norm()));
  EXPECT_EQ(out.tail(out.size() - n).norm(), 0.0);
  for (int i = 0; i < n; ++i) {
    const double squared = factor.column(i, -1.0, out.data());
    EXPECT_LE((l * out.head(n) + Eigen::VectorXd::Unit(n, i)).norm(), 1e-11 * (1.0 + out.norm()));
    EXPECT_NEAR(squared, out.squaredNorm(), 1e-12 * (1.0 + squared));
  }
}

TEST(BlockCholesky, EverySizeOfDenseMatrix) {
  BlockCholesky factor(70);
  Random random(1);
  for (int n = 1; n <= 70; ++n) {
    const Eigen::MatrixXd h = random_spd(n, &random);
    factor.analyse(h);
    EXPECT_EQ(factor.block_count(), 1);
    ASSERT_TRUE(factor.factor(h, nullptr, 1e-12));
    check_against_eigen(factor, h, &random);
  }
}

TEST(BlockCholesky, FindsRandomBlockStructures) {
  BlockCholesky factor(100);
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const int n = random.integer(2, 100);
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(n, n);
    int expected = 0;
    bool diagonal = false;
    for (int begin = 0; begin < n;) {
      const int largest = n - begin;
      const int size = random.chance(0.5) ? 1 : random.integer(1, largest);
      h.block(begin, begin, size, size) = random_spd(size, &random);
      if (size > 1 || !diagonal) ++expected;
      diagonal = size == 1;
      begin += size;
    }
    factor.analyse(h);
    EXPECT_EQ(factor.block_count(), expected) << seed;
    ASSERT_TRUE(factor.factor(h, nullptr, 1e-12));
    check_against_eigen(factor, h, &random);
  }
}

TEST(BlockCholesky, RefusesSingularAndAcceptsShifted) {
  Random random(2);
  const Eigen::MatrixXd a = random.matrix(3, 9);
  const Eigen::MatrixXd h = a.transpose() * a;
  BlockCholesky factor(9);
  factor.analyse(h);
  EXPECT_FALSE(factor.factor(h, nullptr, 1e-10));
  const Eigen::VectorXd shift = Eigen::VectorXd::Constant(9, 1e-3);
  ASSERT_TRUE(factor.factor(h, shift.data(), 1e-10));
  check_against_eigen(factor, h + 1e-3 * Eigen::MatrixXd::Identity(9, 9), &random);
}

TEST(ThinQr, FollowsRandomAppendsAndRemovals) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    const int n = random.integer(1, 60);
    const int ld = kernels::padded(n);
    ThinQr qr(60);
    qr.reset(n);
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(ld, 0);
    Eigen::VectorXd d = Eigen::VectorXd::Zero(ld), z = d, r = d, p = d;
    for (int step = 0; step < 150; ++step) {
      const int q = static_cast<int>(b.cols());
      if (!qr.full() && (q == 0 || random.chance(0.6))) {
        Eigen::VectorXd column = Eigen::VectorXd::Zero(ld);
        column.head(n) = random.vector(n);
        const double squared = qr.project(column.data(), d.data(), z.data());
        qr.append(d.data(), z.data(), squared);
        b.conservativeResize(Eigen::NoChange, q + 1);
        b.col(q) = column;
      } else {
        const int k = random.integer(0, q - 1);
        qr.remove(k);
        b.middleCols(k, q - 1 - k) = b.rightCols(q - 1 - k).eval();
        b.conservativeResize(Eigen::NoChange, q - 1);
      }
      ASSERT_EQ(qr.size(), b.cols());
    }
    const int q = qr.size();
    // Least squares: R⁻¹ Qᵀ B w = w, and B (R⁻¹ Qᵀ v) is the projection of v.
    const Eigen::VectorXd w = random.vector(q);
    const Eigen::VectorXd bw = b * w;
    qr.multiply_transposed(bw.data(), d.data());
    qr.solve(d.data(), r.data());
    EXPECT_LE((b * r.head(q) - bw).norm(), 1e-9 * (1.0 + bw.norm())) << seed;
    qr.solve_transposed(w.data(), p.data());
    Eigen::VectorXd y = Eigen::VectorXd::Zero(ld);
    qr.multiply_add(p.data(), 1.0, y.data());
    EXPECT_LE((b.transpose() * y - w).norm(), 1e-8 * (1.0 + y.norm() * b.norm())) << seed;
    // What is left after the projection is orthogonal to every column.
    Eigen::VectorXd v = Eigen::VectorXd::Zero(ld);
    v.head(n) = random.vector(n);
    qr.project(v.data(), d.data(), z.data());
    EXPECT_LE((b.transpose() * z).norm(), 1e-11 * (1.0 + b.norm())) << seed;
  }
}

TEST(ThinQr, SeesDependentColumns) {
  Random random(3);
  ThinQr qr(16);
  qr.reset(16);
  const Eigen::MatrixXd b = random.matrix(16, 5);
  Eigen::VectorXd d(16), z(16);
  for (int j = 0; j < 5; ++j) {
    const double squared = qr.project(b.col(j).data(), d.data(), z.data());
    qr.append(d.data(), z.data(), squared);
  }
  const Eigen::VectorXd combination = b * random.vector(5);
  const double left = qr.project(combination.data(), d.data(), z.data());
  EXPECT_LE(left, 1e-28 * combination.squaredNorm());
}

}  // namespace
}  // namespace gaitd::qp
