// SPDX-License-Identifier: Apache-2.0
#include "null_space_projector.h"

#include <algorithm>
#include <cmath>

namespace gaitd::plugins {

NullSpaceProjector::NullSpaceProjector(int columns, int max_rows)
    : columns_(columns), claimed_(columns), place_(columns), column_(columns) {
  ease_.setOnes(columns);
  J_.setZero(max_rows, columns);
  X_.setZero(max_rows, columns);
  gram_.setZero(max_rows, max_rows);
}

void NullSpaceProjector::clear() {
  rows_ = 0;
  std::fill(claimed_.begin(), claimed_.end(), false);
  ease_.setOnes();
}

void NullSpaceProjector::add(
    const Eigen::Ref<const Eigen::RowVectorXd, 0, Eigen::InnerStride<>>& row) {
  if (rows_ < J_.rows()) J_.row(rows_++) = row;
}

void NullSpaceProjector::compute(double alpha) {
  free_ = 0;
  for (int c = 0; c < columns_; ++c) {
    place_[c] = claimed_[c] ? -1 : free_;
    if (!claimed_[c]) column_[free_++] = c;
  }
  int kept = 0;
  for (int r = 0; r < rows_; ++r) {
    for (int k = 0; k < free_; ++k) X_(kept, k) = J_(r, column_[k]) * ease_[column_[k]];
    const double length = X_.row(kept).head(free_).norm();
    if (length < 1e-9) continue;
    X_.row(kept++).head(free_) /= length;
  }
  rows_ = kept;
  auto X = X_.topLeftCorner(rows_, free_);
  auto L = gram_.topLeftCorner(rows_, rows_);
  for (int i = 0; i < rows_; ++i) {
    for (int j = 0; j <= i; ++j) L(i, j) = X.row(i).dot(X.row(j));
  }
  L.diagonal().array() += alpha * alpha;
  // Cholesky factor row by row, L^-1 J D on the way.
  for (int i = 0; i < rows_; ++i) {
    for (int j = 0; j < i; ++j) {
      L(i, j) = (L(i, j) - L.row(i).head(j).dot(L.row(j).head(j))) / L(j, j);
    }
    L(i, i) = std::sqrt(std::max(L(i, i) - L.row(i).head(i).squaredNorm(), 1e-18));
    for (int j = 0; j < i; ++j) X.row(i) -= L(i, j) * X.row(j);
    X.row(i) /= L(i, i);
  }
  trace_ = free_ - X.squaredNorm();
}

void NullSpaceProjector::row(int column, Eigen::Ref<Eigen::VectorXd> out) const {
  out.setZero();
  const int place = place_[column];
  if (place < 0) return;
  auto row = out.head(free_);
  for (int r = 0; r < rows_; ++r) row -= X_(r, place) * X_.row(r).head(free_).transpose();
  row[place] += 1.0;
  // Spread from the free places to their columns, which never come before them.
  for (int k = free_ - 1; k >= 0; --k) {
    const double entry = out[k];
    out[k] = 0.0;
    out[column_[k]] = entry * (ease_[column] / ease_[column_[k]]);
  }
}

}  // namespace gaitd::plugins
