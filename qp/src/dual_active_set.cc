// SPDX-License-Identifier: Apache-2.0
#include "dual_active_set.h"

#include <algorithm>
#include <cmath>

#include "kernels.h"

namespace gaitd::qp {
namespace {

// A normal counts as dependent when less than this part of it, in the metric of H⁻¹, is new. A
// guessed constraint has to be better than that: it must not spoil the start.
constexpr double kDependent = 1e-9;
constexpr double kGuessDependent = 1e-6;
// Violations below this, relative to the point, are rounding.
constexpr double kViolation = 2e-12;
// Components of a dual direction below this are rounding.
constexpr double kDirection = 1e-12;

double max_abs(int n, const double* v) {
  double result = 0.0;
  for (int i = 0; i < n; ++i) result = std::max(result, std::abs(v[i]));
  return result;
}

}  // namespace

DualActiveSet::DualActiveSet(const Dimensions& max) : qr_(max.unknowns) {
  const int n = kernels::padded(max.unknowns) + kernels::kWidth;
  const int rows = max.equalities + max.inequalities;
  id_.resize(n);
  sign_.resize(n);
  state_.resize(rows + max.unknowns);
  for (auto* v : {&lambda_, &side_, &p_, &d_, &r_, &x_, &c_, &normal_, &z_, &step_, &work_,
                  &previous_x_, &previous_lambda_}) {
    *v = Eigen::VectorXd::Zero(n);
  }
  values_ = Eigen::VectorXd::Zero(rows);
}

void DualActiveSet::bind(const ConstraintSet* constraints, const BlockCholesky* cholesky) {
  constraints_ = constraints;
  cholesky_ = cholesky;
  n_ = constraints->unknowns();
  padded_ = kernels::padded(n_);
  for (auto* v : {&x_, &c_, &normal_, &z_, &step_, &work_}) v->setZero();
}

void DualActiveSet::set_gradient(const double* g) { cholesky_->apply(g, c_.data()); }

double DualActiveSet::side(int id, double sign) const {
  return sign > 0.0 ? constraints_->lower(id) : -constraints_->upper(id);
}

double DualActiveSet::whiten(int id, double sign, double* out) {
  if (constraints_->is_bound(id)) {
    return cholesky_->column(constraints_->unknown_of(id), sign, out);
  }
  cholesky_->apply(constraints_->normal(id), out);
  if (sign < 0.0) {
    for (int i = 0; i < padded_; ++i) out[i] = -out[i];
  }
  return kernels::dot(padded_, out, out);
}

void DualActiveSet::append(int id, double sign, double multiplier, double squared_norm) {
  const int k = qr_.size();
  qr_.append(d_.data(), z_.data(), squared_norm);
  id_[k] = id;
  sign_[k] = sign;
  side_[k] = side(id, sign);
  lambda_[k] = multiplier;
  state_[id] = kActive;
}

bool DualActiveSet::try_append(int id, double sign, double threshold) {
  const double before = whiten(id, sign, normal_.data());
  const double after = qr_.project(normal_.data(), d_.data(), z_.data());
  if (qr_.full() || !(after > threshold * threshold * before)) return false;
  append(id, sign, 0.0, after);
  return true;
}

void DualActiveSet::remove(int k) {
  state_[id_[k]] = kInactive;
  qr_.remove(k);
  const int size = qr_.size();
  for (int i = k; i < size; ++i) {
    id_[i] = id_[i + 1];
    sign_[i] = sign_[i + 1];
    side_[i] = side_[i + 1];
    lambda_[i] = lambda_[i + 1];
  }
}

DualActiveSet::Outcome DualActiveSet::build(const std::int8_t* guess, double tolerance) {
  qr_.reset(n_);
  std::fill(state_.begin(), state_.begin() + constraints_->size(), kInactive);
  bool feasible = true;
  // Bounds first: a fixed unknown then takes its value exactly.
  const int count = constraints_->size();
  for (int i = 0; i < count; ++i) {
    const int id = i < n_ ? constraints_->rows() + i : i - n_;
    if (!constraints_->is_equality(id) || try_append(id, 1.0, kDependent)) continue;
    state_[id] = kExcluded;
    qr_.solve(d_.data(), r_.data());
    if (contradicts(id, 1.0, tolerance)) feasible = false;
    for (int k = 0; k < qr_.size(); ++k) r_[k] = -r_[k];
    if (contradicts(id, -1.0, tolerance)) feasible = false;
  }
  fixed_ = qr_.size();
  if (!feasible) {
    restart();
    return Outcome::infeasible;
  }
  if (guess != nullptr) {
    for (int id = 0; id < count; ++id) {
      if (guess[id] == 0 || state_[id] != kInactive) continue;
      const double sign = guess[id] < 0 ? 1.0 : -1.0;
      if (std::isfinite(side(id, sign))) try_append(id, sign, kGuessDependent);
    }
  }
  return Outcome::optimal;
}

void DualActiveSet::solve_working_set() {
  const int size = qr_.size();
  qr_.solve_transposed(side_.data(), p_.data());
  qr_.multiply_transposed(c_.data(), r_.data());
  for (int k = 0; k < size; ++k) p_[k] += r_[k];
  qr_.solve(p_.data(), lambda_.data());
}

void DualActiveSet::update_x() {
  for (int i = 0; i < padded_; ++i) work_[i] = -c_[i];
  qr_.multiply_add(p_.data(), 1.0, work_.data());
  cholesky_->apply_transposed(work_.data(), x_.data());
}

void DualActiveSet::restart() {
  for (int id = 0; id < constraints_->size(); ++id) {
    if (state_[id] == kExcluded && !constraints_->is_equality(id)) state_[id] = kInactive;
  }
  for (;;) {
    solve_working_set();
    int worst = -1;
    for (int k = fixed_; k < qr_.size(); ++k) {
      if (lambda_[k] < 0.0 && (worst < 0 || lambda_[k] < lambda_[worst])) worst = k;
    }
    if (worst < 0) break;
    remove(worst);
  }
  update_x();
}

// Whether the constraint that depends on the working set, with coefficients r_, contradicts it: a
// Farkas certificate, checked on the normals and sides themselves and not on the current x.
bool DualActiveSet::contradicts(int id, double sign, double tolerance) {
  double* v = step_.data();
  std::fill_n(v, padded_, 0.0);
  constraints_->add_normal(id, sign, v);
  double gap = side(id, sign);
  double scale = std::abs(gap);
  double weight = 1.0;
  for (int k = 0; k < qr_.size(); ++k) {
    constraints_->add_normal(id_[k], -r_[k] * sign_[k], v);
    gap -= r_[k] * side_[k];
    scale = std::max(scale, std::abs(r_[k] * side_[k]));
    weight = std::max(weight, std::abs(r_[k]));
  }
  constexpr double kParallel = 1e-8;
  constexpr double kShare = 1e-2;  // of the gap that the rest of the normal may explain
  const double rest = max_abs(n_, v);
  return gap > tolerance * (1.0 + scale) && rest < kParallel * weight &&
         rest * (1.0 + max_abs(n_, x_.data())) < kShare * gap;
}

DualActiveSet::Candidate DualActiveSet::most_violated() {
  const int rows = constraints_->rows();
  constraints_->row_values(x_.data(), values_.data());
  const double row_tolerance = kViolation * (1.0 + max_abs(n_, x_.data()));
  Candidate best;
  const auto consider = [&](int id, double value, double tolerance) {
    if (state_[id] != kInactive) return;
    const double below = constraints_->lower(id) - value;
    const double above = value - constraints_->upper(id);
    const double violation = std::max(below, above);
    if (violation > tolerance && violation > best.violation) {
      best = {id, below > above ? 1.0 : -1.0, violation};
    }
  };
  for (int id = 0; id < rows; ++id) consider(id, values_[id], row_tolerance);
  for (int i = 0; i < n_; ++i) consider(rows + i, x_[i], kViolation * (1.0 + std::abs(x_[i])));
  return best;
}

DualActiveSet::Outcome DualActiveSet::run(int max_iterations, double tolerance, int* iterations) {
  for (;;) {
    const Candidate candidate = most_violated();
    if (candidate.id < 0) return Outcome::optimal;
    const Outcome outcome = add(candidate, max_iterations, tolerance, iterations);
    if (outcome != Outcome::optimal) return outcome;
  }
}

// Steps of one violated constraint: shorten, dropping blocking constraints, until it is satisfied.
DualActiveSet::Outcome DualActiveSet::add(Candidate candidate, int max_iterations, double tolerance,
                                          int* iterations) {
  const double squared = whiten(candidate.id, candidate.sign, normal_.data());
  double multiplier = 0.0;
  double violation = candidate.violation;
  for (;;) {
    if (*iterations >= max_iterations) return Outcome::limit;
    ++*iterations;
    const double curvature = qr_.project(normal_.data(), d_.data(), z_.data());
    qr_.solve(d_.data(), r_.data());
    const bool dependent = qr_.full() || !(curvature > kDependent * kDependent * squared);
    const int size = qr_.size();

    double dual_step = kernels::kInfinity;
    int blocking = -1;
    const double threshold = kDirection * std::max(1.0, max_abs(size, r_.data()));
    for (int k = fixed_; k < size; ++k) {
      if (r_[k] <= threshold) continue;
      const double ratio = lambda_[k] / r_[k];
      // Of equal ratios the larger component is the safer one to divide by.
      if (ratio < dual_step || (ratio == dual_step && r_[k] > r_[blocking])) {
        dual_step = ratio;
        blocking = k;
      }
    }
    const double full_step = dependent ? kernels::kInfinity : violation / curvature;
    if (dependent && blocking < 0) {
      if (contradicts(candidate.id, candidate.sign, tolerance)) return Outcome::infeasible;
      state_[candidate.id] = kExcluded;
      return Outcome::optimal;
    }

    const bool complete = full_step <= dual_step;
    const double step = complete ? full_step : dual_step;
    if (!dependent) {
      cholesky_->apply_transposed(z_.data(), step_.data());
      kernels::axpy(padded_, step, step_.data(), x_.data());
    }
    for (int k = 0; k < size; ++k) lambda_[k] -= step * r_[k];
    for (int k = fixed_; k < size; ++k) lambda_[k] = std::max(lambda_[k], 0.0);
    multiplier += step;
    if (complete) {
      append(candidate.id, candidate.sign, multiplier, curvature);
      return Outcome::optimal;
    }
    remove(blocking);
    const double value = constraints_->value(candidate.id, x_.data());
    violation = std::max(0.0, side(candidate.id, candidate.sign) - candidate.sign * value);
  }
}

void DualActiveSet::correct(const double* stationarity) {
  const int size = qr_.size();
  previous_x_.head(padded_) = x_.head(padded_);
  previous_lambda_.head(size) = lambda_.head(size);
  std::copy_n(stationarity, n_, normal_.data());
  std::fill(normal_.data() + n_, normal_.data() + padded_, 0.0);
  cholesky_->apply(normal_.data(), z_.data());
  for (int k = 0; k < size; ++k) {
    d_[k] = side_[k] - sign_[k] * constraints_->value(id_[k], x_.data());
  }
  qr_.solve_transposed(d_.data(), p_.data());
  qr_.multiply_transposed(z_.data(), r_.data());
  for (int k = 0; k < size; ++k) p_[k] += r_[k];
  qr_.solve(p_.data(), r_.data());
  for (int k = 0; k < size; ++k) lambda_[k] += r_[k];
  for (int k = fixed_; k < size; ++k) lambda_[k] = std::max(lambda_[k], 0.0);
  for (int i = 0; i < padded_; ++i) z_[i] = -z_[i];
  qr_.multiply_add(p_.data(), 1.0, z_.data());
  cholesky_->apply_transposed(z_.data(), step_.data());
  kernels::axpy(padded_, 1.0, step_.data(), x_.data());
}

void DualActiveSet::revert() {
  x_.head(padded_) = previous_x_.head(padded_);
  lambda_.head(qr_.size()) = previous_lambda_.head(qr_.size());
}

}  // namespace gaitd::qp
