// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace gaitd::plugins {

// Damped projector onto what no task claims (Griffin et al. 2018; theory section 4):
//   N = I - D^2 J' (J D^2 J' + alpha^2 I)^-1 J
// with the rows of J D scaled to unit length. The tasks are served by the unknowns in proportion to
// the square of their ease, the diagonal of D; it is 1 unless said otherwise. Columns that tasks of
// single joints claim are taken out beforehand: nothing is free there. Allocates at construction
// only.
class NullSpaceProjector {
 public:
  NullSpaceProjector(int columns, int max_rows);

  // Begins with no task, and every ease 1.
  void clear();
  // Tasks that this unknown and others can serve are left to it the more, the larger its ease.
  void ease(int column, double ease) { ease_[column] = ease; }
  // A task of a single unknown: the column is taken.
  void claim(int column) { claimed_[column] = true; }
  // A task row; rows of no length claim nothing.
  void add(const Eigen::Ref<const Eigen::RowVectorXd, 0, Eigen::InnerStride<>>& row);
  // Computes N for damping `alpha`.
  void compute(double alpha);

  // row = N.row(column); nonzero only where nothing is claimed.
  void row(int column, Eigen::Ref<Eigen::VectorXd> out) const;
  // Number of freedoms that are left.
  double trace() const { return trace_; }

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  const int columns_;
  int rows_ = 0;
  int free_ = 0;
  double trace_ = 0.0;
  std::vector<bool> claimed_;
  std::vector<int> place_;   // of a column among the free ones, -1 if claimed
  std::vector<int> column_;  // of a free place
  Eigen::VectorXd ease_;     // diagonal of D
  Rows J_;                   // max_rows x columns, all columns as added
  Rows X_;                   // free columns of J D, then L^-1 J D
  Rows gram_;                // J D^2 J' + alpha^2 I, then its Cholesky factor
};

}  // namespace gaitd::plugins
