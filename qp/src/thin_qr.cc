// SPDX-License-Identifier: Apache-2.0
#include "thin_qr.h"

#include <algorithm>
#include <cmath>

#include "kernels.h"

namespace gaitd::qp {

using kernels::padded;

ThinQr::ThinQr(int max_n)
    : ldr_(padded(max_n)),
      q_(Eigen::VectorXd::Zero(padded(max_n) * padded(max_n))),
      r_(Eigen::VectorXd::Zero(padded(max_n) * padded(max_n))),
      inverse_diagonal_(Eigen::VectorXd::Zero(padded(max_n))),
      correction_(Eigen::VectorXd::Zero(padded(max_n))) {}

void ThinQr::reset(int n) {
  n_ = n;
  ldq_ = padded(n);
  size_ = 0;
}

double ThinQr::project(const double* b, double* d, double* z) const {
  std::copy_n(b, ldq_, z);
  if (size_ == 0) return kernels::dot(ldq_, z, z);
  const double before = kernels::dot(ldq_, b, b);
  kernels::multiply_transposed(ldq_, size_, q_.data(), ldq_, b, d);
  kernels::multiply_add(ldq_, size_, q_.data(), ldq_, d, -1.0, z);
  double after = kernels::dot(ldq_, z, z);
  // Twice is enough (Giraud et al. 2005); the second pass only where the first one cancelled.
  constexpr double kCancellation = 0.25;
  if (after < kCancellation * before) {
    double* e = correction_.data();
    kernels::multiply_transposed(ldq_, size_, q_.data(), ldq_, z, e);
    kernels::multiply_add(ldq_, size_, q_.data(), ldq_, e, -1.0, z);
    for (int k = 0; k < size_; ++k) d[k] += e[k];
    after = kernels::dot(ldq_, z, z);
  }
  return after;
}

void ThinQr::append(const double* d, const double* z, double squared_norm) {
  const double norm = std::sqrt(squared_norm);
  const double inverse = 1.0 / norm;
  double* q = q_column(size_);
  for (int i = 0; i < ldq_; ++i) q[i] = inverse * z[i];
  double* r = r_column(size_);
  std::copy_n(d, size_, r);
  r[size_] = norm;
  inverse_diagonal_[size_] = inverse;
  ++size_;
}

void ThinQr::remove(int k) {
  for (int j = k + 1; j < size_; ++j) std::copy_n(r_column(j), j + 1, r_column(j - 1));
  --size_;
  for (int j = k; j < size_; ++j) {
    double* r = r_column(j);
    const double a = r[j];
    const double b = r[j + 1];
    const double norm = std::sqrt(a * a + b * b);
    const double c = norm > 0.0 ? a / norm : 1.0;
    const double s = norm > 0.0 ? b / norm : 0.0;
    r[j] = norm;
    inverse_diagonal_[j] = 1.0 / norm;
    for (int i = j + 1; i < size_; ++i) {
      double* column = r_column(i);
      const double upper = column[j];
      const double lower = column[j + 1];
      column[j] = c * upper + s * lower;
      column[j + 1] = c * lower - s * upper;
    }
    kernels::rotate(ldq_, c, s, q_column(j), q_column(j + 1));
  }
}

void ThinQr::solve(const double* d, double* r) const {
  std::copy_n(d, size_, r);
  for (int j = size_ - 1; j >= 0; --j) {
    const double v = r[j] * inverse_diagonal_[j];
    r[j] = v;
    kernels::axpy(j, -v, r_column(j), r);
  }
}

void ThinQr::solve_transposed(const double* v, double* p) const {
  for (int j = 0; j < size_; ++j) {
    p[j] = (v[j] - kernels::dot(j, r_column(j), p)) * inverse_diagonal_[j];
  }
}

void ThinQr::multiply_transposed(const double* v, double* out) const {
  kernels::multiply_transposed(ldq_, size_, q_.data(), ldq_, v, out);
}

void ThinQr::multiply_add(const double* p, double sign, double* out) const {
  kernels::multiply_add(ldq_, size_, q_.data(), ldq_, p, sign, out);
}

}  // namespace gaitd::qp
