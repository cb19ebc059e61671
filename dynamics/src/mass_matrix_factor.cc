// SPDX-License-Identifier: Apache-2.0
// M = L' L. Eliminating from the leaves to the root creates no fill-in: row i of L is zero except
// at i and the entries that carry it (RBDA section 6.5, tables 6.3 and 6.5).
#include <cmath>

#include "gaitd/dynamics/dynamics.h"

namespace gaitd::dynamics {

void Dynamics::factorize() {
  const int nv = velocity_size();
  for (int k = 0; k < nv; ++k) {
    for (int i = k; i >= 0; i = parent_entry_[i]) factor_(k, i) = mass_matrix_(i, k);
  }
  for (int k = nv - 1; k >= 0; --k) {
    const double pivot = std::sqrt(factor_(k, k));
    factor_(k, k) = pivot;
    for (int i = parent_entry_[k]; i >= 0; i = parent_entry_[i]) factor_(k, i) /= pivot;
    for (int i = parent_entry_[k]; i >= 0; i = parent_entry_[i]) {
      const double value = factor_(k, i);
      for (int j = i; j >= 0; j = parent_entry_[j]) factor_(i, j) -= value * factor_(k, j);
    }
  }
  factor_valid_ = true;
}

void Dynamics::solve_mass_matrix(const Eigen::Ref<const Eigen::VectorXd>& b,
                                 Eigen::Ref<Eigen::VectorXd> x) {
  const int nv = velocity_size();
  eigen_assert(b.size() == nv && x.size() == nv);
  if (!factor_valid_) factorize();
  if (x.data() != b.data()) x = b;
  for (int i = nv - 1; i >= 0; --i) {
    x[i] /= factor_(i, i);
    for (int j = parent_entry_[i]; j >= 0; j = parent_entry_[j]) x[j] -= factor_(i, j) * x[i];
  }
  for (int i = 0; i < nv; ++i) {
    double sum = x[i];
    for (int j = parent_entry_[i]; j >= 0; j = parent_entry_[j]) sum -= factor_(i, j) * x[j];
    x[i] = sum / factor_(i, i);
  }
}

}  // namespace gaitd::dynamics
