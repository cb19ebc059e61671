// SPDX-License-Identifier: Apache-2.0
#include "block_cholesky.h"

#include <algorithm>
#include <cmath>

#include "kernels.h"

namespace gaitd::qp {
namespace {

using kernels::broadcast;
using kernels::kWidth;
using kernels::load;
using kernels::padded;
using kernels::store;
using kernels::Vec4;

// t(i.., 0..3) −= Σ_{k<depth} l(i.., k) r(c, k) for `Tiles` tiles of four rows; r points to the row
// of L that belongs to column c.
template <int Tiles>
void subtract_product(int depth, int ld, const double* l, const double* r, double* t) {
  Vec4 acc[Tiles][4];
  for (int v = 0; v < Tiles; ++v) {
    for (int c = 0; c < 4; ++c) acc[v][c] = load(t + c * ld + v * kWidth);
  }
  for (int k = 0; k < depth; ++k) {
    Vec4 rows[Tiles];
    for (int v = 0; v < Tiles; ++v) rows[v] = load(l + k * ld + v * kWidth);
    for (int c = 0; c < 4; ++c) {
      const Vec4 factor = broadcast(r[k * ld + c]);
      for (int v = 0; v < Tiles; ++v) acc[v][c] -= rows[v] * factor;
    }
  }
  for (int v = 0; v < Tiles; ++v) {
    for (int c = 0; c < 4; ++c) store(t + c * ld + v * kWidth, acc[v][c]);
  }
}

// Inverse of the lower triangular 4 × 4 tile at d (leading dimension ld), column-major.
void invert_tile(const double* d, int ld, double* out) {
  std::fill_n(out, 16, 0.0);
  for (int c = 0; c < 4; ++c) {
    out[c * 4 + c] = 1.0 / d[c * ld + c];
    for (int r = c + 1; r < 4; ++r) {
      double s = 0.0;
      for (int k = c; k < r; ++k) s += d[k * ld + r] * out[c * 4 + k];
      out[c * 4 + r] = -s / d[r * ld + r];
    }
  }
}

}  // namespace

BlockCholesky::BlockCholesky(int max_n)
    : blocks_(static_cast<std::size_t>(std::max(max_n, 1))),
      block_of_(static_cast<std::size_t>(std::max(max_n, 1))),
      // Padding each block costs at most three rows per unknown, beside the dense square.
      l_(Eigen::VectorXd::Zero(padded(max_n) * padded(max_n) + 4 * kWidth * padded(max_n))),
      inverse_(Eigen::VectorXd::Zero(l_.size())),
      pivot_inverse_(Eigen::VectorXd::Zero(4 * padded(max_n))) {}

void BlockCholesky::analyse(const MatrixView& h) {
  n_ = h.rows();
  block_count_ = 0;
  int begin = 0;
  int reach = 0;  // last row that a column of the current block touches
  int offset = 0;
  for (int j = 0; j < n_; ++j) {
    const double* column = h.column(j);
    int last = n_ - 1;
    while (last > reach && column[last] == 0.0) --last;
    reach = std::max({reach, last, j});
    if (reach > j) continue;
    const int size = j + 1 - begin;
    Block* previous = block_count_ > 0 ? &blocks_[block_count_ - 1] : nullptr;
    if (size == 1 && previous != nullptr && previous->diagonal) {
      ++previous->size;
      ++offset;
    } else {
      blocks_[block_count_++] = {begin, size, size == 1, offset};
      offset += size == 1 ? 1 : padded(size) * padded(size);
    }
    begin = j + 1;
    reach = begin;
  }
  // A diagonal run is read in whole vectors: keep its storage apart from what follows.
  offset = 0;
  for (int k = 0; k < block_count_; ++k) {
    Block& block = blocks_[k];
    block.offset = offset;
    offset += padded(block.size) * (block.diagonal ? 1 : padded(block.size));
    std::fill_n(block_of_.begin() + block.begin, block.size, k);
  }
}

bool BlockCholesky::factor(const MatrixView& h, const double* shift, double threshold) {
  for (int k = 0; k < block_count_; ++k) {
    const Block& block = blocks_[k];
    const bool ok = block.diagonal ? factor_diagonal(block, h, shift, threshold)
                                   : factor_dense(block, h, shift, threshold);
    if (!ok) return false;
  }
  for (int k = 0; k < block_count_; ++k) {
    if (!blocks_[k].diagonal) invert_dense(blocks_[k]);
  }
  return true;
}

bool BlockCholesky::factor_diagonal(const Block& block, const MatrixView& h, const double* shift,
                                    double threshold) {
  double* inverse = inverse_.data() + block.offset;
  for (int i = 0; i < block.size; ++i) {
    const int row = block.begin + i;
    const double h_ii = h(row, row);
    const double pivot = shift != nullptr ? h_ii + shift[row] : h_ii;
    if (!(pivot > threshold * std::abs(h_ii)) || !(pivot > 0.0)) return false;
    inverse[i] = 1.0 / std::sqrt(pivot);
  }
  std::fill(inverse + block.size, inverse + padded(block.size), 0.0);
  return true;
}

// Left-looking by panels of four columns; rows and columns beyond the size are those of the unit
// matrix, so that every tile is whole.
bool BlockCholesky::factor_dense(const Block& block, const MatrixView& h, const double* shift,
                                 double threshold) {
  const int n = block.size;
  const int ld = padded(n);
  double* l = l_.data() + block.offset;
  for (int j = 0; j < n; ++j) {
    const double* source = h.column(block.begin + j) + block.begin;
    double* target = l + j * ld;
    std::copy(source + j, source + n, target + j);
    std::fill(target + n, target + ld, 0.0);
    if (shift != nullptr) target[j] += shift[block.begin + j];
  }
  for (int j = n; j < ld; ++j) {
    std::fill_n(l + j * ld, ld, 0.0);
    l[j * ld + j] = 1.0;
  }
  for (int j = 0; j < ld; j += 4) {
    double diagonal[4];
    for (int c = 0; c < 4; ++c) diagonal[c] = l[(j + c) * ld + j + c];
    double* panel = l + j * ld;
    int i = j;
    for (; i + 2 * kWidth <= ld; i += 2 * kWidth) {
      subtract_product<2>(j, ld, l + i, l + j, panel + i);
    }
    if (i < ld) subtract_product<1>(j, ld, l + i, l + j, panel + i);
    for (int c = 0; c < 4; ++c) {
      double* column = panel + c * ld;
      for (int k = 0; k < c; ++k) {
        kernels::axpy(ld - j, -panel[k * ld + j + c], panel + k * ld + j, column + j);
      }
      const double pivot = column[j + c];
      if (!(pivot > threshold * std::abs(diagonal[c])) || !(pivot > 0.0)) return false;
      const Vec4 scale = broadcast(1.0 / std::sqrt(pivot));
      for (int r = j; r < ld; r += kWidth) store(column + r, scale * load(column + r));
    }
  }
  return true;
}

// L X = I by tiles of four rows and four columns: X_ij = L_ii⁻¹ (δ_ij I − Σ_k L_ik X_kj).
void BlockCholesky::invert_dense(const Block& block) {
  const int ld = padded(block.size);
  const double* l = l_.data() + block.offset;
  double* x = inverse_.data() + block.offset;
  for (int i = 0; i < ld; i += 4) {
    double* tile = pivot_inverse_.data() + 4 * i;
    invert_tile(l + i * ld + i, ld, tile);
    for (int c = 0; c < 4; ++c) {
      double* column = x + (i + c) * ld;
      std::fill_n(column, i, 0.0);
      store(column + i, load(tile + 4 * c));
    }
  }
  for (int j = 0; j < ld; j += 4) {
    for (int i = j + 4; i < ld; i += 4) {
      Vec4 acc[4] = {};
      Vec4 odd[4] = {};
      for (int k = j; k < i; k += 2) {
        const Vec4 l0 = load(l + k * ld + i);
        const Vec4 l1 = load(l + (k + 1) * ld + i);
        for (int c = 0; c < 4; ++c) {
          acc[c] -= l0 * broadcast(x[(j + c) * ld + k]);
          odd[c] -= l1 * broadcast(x[(j + c) * ld + k + 1]);
        }
      }
      const double* tile = pivot_inverse_.data() + 4 * i;
      for (int c = 0; c < 4; ++c) {
        const Vec4 rhs = acc[c] + odd[c];
        const Vec4 a = broadcast(rhs[0]) * load(tile) + broadcast(rhs[1]) * load(tile + 4);
        const Vec4 b = broadcast(rhs[2]) * load(tile + 8) + broadcast(rhs[3]) * load(tile + 12);
        store(x + (j + c) * ld + i, a + b);
      }
    }
  }
}

void BlockCholesky::apply(const double* v, double* out) const {
  std::fill_n(out, padded(n_) + kWidth, 0.0);
  for (int k = 0; k < block_count_; ++k) {
    const Block& block = blocks_[k];
    const double* m = inverse_.data() + block.offset;
    const double* in = v + block.begin;
    double* to = out + block.begin;
    if (block.diagonal) {
      for (int i = 0; i < block.size; ++i) to[i] = m[i] * in[i];
      continue;
    }
    const int ld = padded(block.size);
    for (int j = 0; j < ld; j += 4) {
      const int columns = std::min(4, block.size - j);
      kernels::multiply_add(ld - j, columns, m + j * ld + j, ld, in + j, 1.0, to + j);
    }
  }
}

void BlockCholesky::apply_transposed(const double* v, double* out) const {
  std::fill_n(out + n_, padded(n_) + kWidth - n_, 0.0);
  for (int k = 0; k < block_count_; ++k) {
    const Block& block = blocks_[k];
    const double* m = inverse_.data() + block.offset;
    const double* in = v + block.begin;
    double* to = out + block.begin;
    if (block.diagonal) {
      for (int i = 0; i < block.size; ++i) to[i] = m[i] * in[i];
      continue;
    }
    const int ld = padded(block.size);
    for (int j = 0; j < block.size; j += 4) {
      const int columns = std::min(4, block.size - j);
      kernels::multiply_transposed(ld - j, columns, m + j * ld + j, ld, in + j, to + j);
    }
  }
}

double BlockCholesky::column(int i, double sign, double* out) const {
  std::fill_n(out, padded(n_) + kWidth, 0.0);
  const Block& block = blocks_[block_of_[i]];
  const int local = i - block.begin;
  const double* m = inverse_.data() + block.offset;
  if (block.diagonal) {
    out[i] = sign * m[local];
    return out[i] * out[i];
  }
  const int ld = padded(block.size);
  double* to = out + block.begin;
  const double* from = m + local * ld;
  double squared = 0.0;
  for (int r = local; r < block.size; ++r) {
    to[r] = sign * from[r];
    squared += to[r] * to[r];
  }
  return squared;
}

}  // namespace gaitd::qp
