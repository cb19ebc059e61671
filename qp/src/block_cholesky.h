// SPDX-License-Identifier: Apache-2.0
#ifndef GAITD_QP_SRC_BLOCK_CHOLESKY_H_
#define GAITD_QP_SRC_BLOCK_CHOLESKY_H_

#include <Eigen/Core>
#include <vector>

#include "gaitd/qp/problem.h"

namespace gaitd::qp {

/// Cholesky factor H + diag(shift) = L Lᵀ and the inverse L⁻¹, block by block.
///
/// The finest partition of H into consecutive diagonal blocks is found by looking for zeros; a run
/// of 1 × 1 blocks stays a diagonal. A dense H is one block. L⁻¹ is formed because the solver
/// needs many of its columns (the normals of the bounds) and products with it.
/// Vectors handed in and out have room for kernels::padded(n) + kernels::kWidth entries, zeros
/// from n on.
class BlockCholesky {
 public:
  /// Allocates for n ≤ max_n; nothing else here allocates.
  explicit BlockCholesky(int max_n);

  /// Finds the block structure of the lower triangle of h. Call before factor().
  void analyse(const MatrixView& h);

  /// Factors. `shift` has n non-negative entries, or is null for none. False when a pivot is not
  /// larger than `threshold` times its diagonal entry.
  bool factor(const MatrixView& h, const double* shift, double threshold);

  /// out = L⁻¹ v.
  void apply(const double* v, double* out) const;
  /// out = L⁻ᵀ v.
  void apply_transposed(const double* v, double* out) const;
  /// out = sign · L⁻¹ e_i; returns its squared norm.
  double column(int i, double sign, double* out) const;

  int size() const { return n_; }
  int block_count() const { return static_cast<int>(block_count_); }

 private:
  struct Block {
    int begin = 0;
    int size = 0;
    bool diagonal = false;
    int offset = 0;  // of the first entry in l_ and inverse_; leading dimension padded(size)
  };

  bool factor_dense(const Block& block, const MatrixView& h, const double* shift, double threshold);
  bool factor_diagonal(const Block& block, const MatrixView& h, const double* shift,
                       double threshold);
  void invert_dense(const Block& block);

  int n_ = 0;
  int block_count_ = 0;
  std::vector<Block> blocks_;
  std::vector<int> block_of_;
  Eigen::VectorXd l_;
  Eigen::VectorXd inverse_;
  Eigen::VectorXd pivot_inverse_;  // 4 × 4 inverses of the diagonal tiles, column-major
};

}  // namespace gaitd::qp

#endif  // GAITD_QP_SRC_BLOCK_CHOLESKY_H_
