// SPDX-License-Identifier: Apache-2.0
#include "gaitd/qp/dense_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "block_cholesky.h"
#include "constraint_set.h"
#include "dual_active_set.h"
#include "kernels.h"

namespace gaitd::qp {
namespace {

// Below this relative pivot H counts as singular and the proximal method takes over.
constexpr double kSingularPivot = 1e-10;
// Residuals under this are rounding: not worth another refinement.
constexpr double kRounding = 1e-12;
constexpr int kMaxRefinements = 3;
constexpr int kMaxRounds = 60;
constexpr int kPatientRounds = 8;

Dimensions at_least_zero(Dimensions d) {
  return {std::max(d.unknowns, 0), std::max(d.equalities, 0), std::max(d.inequalities, 0)};
}

bool fits(const Dimensions& d, const Dimensions& max) {
  return d.unknowns <= max.unknowns && d.equalities <= max.equalities &&
         d.inequalities <= max.inequalities;
}

}  // namespace

const char* to_string(Status status) {
  switch (status) {
    case Status::solved:
      return "solved";
    case Status::max_iterations:
      return "max_iterations";
    case Status::infeasible:
      return "infeasible";
    case Status::non_finite:
      return "non_finite";
    case Status::non_convex:
      return "non_convex";
    case Status::invalid_dimensions:
      return "invalid_dimensions";
  }
  return "unknown";
}

class DenseSolver::Impl {
 public:
  explicit Impl(const Dimensions& max)
      : max_(max), constraints_(max), cholesky_(max.unknowns), core_(max), judge_(max) {
    const int n = kernels::padded(max.unknowns) + kernels::kWidth;
    for (auto* v : {&x_, &w_, &gradient_, &shift_}) *v = Eigen::VectorXd::Zero(n);
    y_ = Eigen::VectorXd::Zero(max.equalities);
    z_ = Eigen::VectorXd::Zero(max.inequalities);
    guess_.resize(max.equalities + max.inequalities + max.unknowns);
    row_sides_.resize(max.inequalities, Side::none);
    bound_sides_.resize(max.unknowns, Side::none);
  }

  Result solve(const Problem& problem, const Options& options);
  void reset_warm_start() { known_rows_ = known_bounds_ = 0; }
  const Dimensions& max() const { return max_; }

 private:
  bool finite_cost(const Problem& problem) const;
  bool factor(const Problem& problem);
  void choose_shift(const Problem& problem);
  void make_guess(const Options& options);
  void set_gradient(const Problem& problem);
  void extract(const Problem& problem);
  double evaluate(const Problem& problem);
  double judge(const Problem& problem);
  std::optional<Status> load(const Problem& problem, double tolerance);
  bool refine(const Problem& problem);
  Status iterate(const Problem& problem, const Options& options);
  Result finish(const Problem& problem, Status status);

  Dimensions max_;
  ConstraintSet constraints_;
  BlockCholesky cholesky_;
  DualActiveSet core_;
  KktJudge judge_;
  KktResiduals residuals_;
  Eigen::VectorXd x_, y_, z_, w_, gradient_, shift_;
  std::vector<std::int8_t> guess_;
  std::vector<Side> row_sides_, bound_sides_;
  int known_rows_ = 0;
  int known_bounds_ = 0;
  int iterations_ = 0;
  bool proximal_ = false;
};

bool DenseSolver::Impl::finite_cost(const Problem& problem) const {
  const int n = problem.g.size();
  bool finite = kernels::all_finite(n, problem.g.data());
  for (int j = 0; j < n; ++j) finite &= kernels::all_finite(n - j, problem.H.column(j) + j);
  return finite;
}

// Proximal weights: small beside H where H has curvature, and such that the gradient alone cannot
// throw an unknown without curvature further than 1e5 in one step.
void DenseSolver::Impl::choose_shift(const Problem& problem) {
  constexpr double kRelative = 1e-6;
  constexpr double kSmallestDiagonal = 1e-3;
  constexpr double kGradient = 1e-5;
  const int n = problem.g.size();
  double largest = 0.0;
  double steepest = 0.0;
  for (int i = 0; i < n; ++i) {
    largest = std::max(largest, problem.H(i, i));
    steepest = std::max(steepest, std::abs(problem.g[i]));
  }
  if (largest == 0.0) largest = steepest > 0.0 ? steepest : 1.0;
  for (int i = 0; i < n; ++i) {
    const double diagonal = std::max(problem.H(i, i), kSmallestDiagonal * largest);
    shift_[i] = std::max(kRelative * diagonal, kGradient * std::abs(problem.g[i]));
  }
}

bool DenseSolver::Impl::factor(const Problem& problem) {
  cholesky_.analyse(problem.H);
  proximal_ = !cholesky_.factor(problem.H, nullptr, kSingularPivot);
  if (!proximal_) return true;
  choose_shift(problem);
  return cholesky_.factor(problem.H, shift_.data(), kSingularPivot);
}

void DenseSolver::Impl::make_guess(const Options& options) {
  std::fill_n(guess_.begin(), constraints_.size(), std::int8_t{0});
  const int rows = constraints_.rows() - constraints_.equality_rows();
  const auto copy = [this](const Side* sides, int count, int first) {
    for (int i = 0; i < count; ++i) guess_[first + i] = static_cast<std::int8_t>(sides[i]);
  };
  if (!options.guess.empty()) {
    const ActiveSet& set = options.guess;
    copy(set.inequalities.data(), std::min(rows, static_cast<int>(set.inequalities.size())),
         constraints_.equality_rows());
    copy(set.bounds.data(), std::min(constraints_.unknowns(), static_cast<int>(set.bounds.size())),
         constraints_.rows());
  } else if (options.warm_start) {
    copy(row_sides_.data(), std::min(rows, known_rows_), constraints_.equality_rows());
    copy(bound_sides_.data(), std::min(constraints_.unknowns(), known_bounds_),
         constraints_.rows());
  }
}

// Gradient at x = 0 of the cost, or of the proximal cost around the current point.
void DenseSolver::Impl::set_gradient(const Problem& problem) {
  const int n = problem.g.size();
  for (int i = 0; i < n; ++i) {
    gradient_[i] = problem.g[i] - (proximal_ ? shift_[i] * core_.x()[i] : 0.0);
  }
  std::fill(gradient_.data() + n, gradient_.data() + gradient_.size(), 0.0);
  core_.set_gradient(gradient_.data());
}

// Copies the point of the core to the caller's signs and scales.
void DenseSolver::Impl::extract(const Problem& problem) {
  const auto [n, p, m] = problem.dimensions();
  x_.head(n) = Eigen::Map<const Eigen::VectorXd>(core_.x(), n);
  y_.head(p).setZero();
  z_.head(m).setZero();
  w_.head(n).setZero();
  for (int k = 0; k < core_.size(); ++k) {
    const int id = core_.id(k);
    const double multiplier = -core_.multiplier(k) * core_.sign(k) / constraints_.length(id);
    if (constraints_.is_bound(id)) {
      const int i = constraints_.unknown_of(id);
      w_[i] = multiplier;
      x_[i] = core_.sign(k) > 0.0 ? constraints_.lower(id) : constraints_.upper(id);
    } else if (id < p) {
      y_[id] = multiplier;
    } else {
      z_[id - p] = multiplier;
    }
  }
}

double DenseSolver::Impl::evaluate(const Problem& problem) {
  const auto [n, p, m] = problem.dimensions();
  const Point point{{x_.data(), n}, {y_.data(), p}, {z_.data(), m}, {w_.data(), n}};
  residuals_ = judge_.evaluate(problem, point);
  return residuals_.scaled.max();
}

double DenseSolver::Impl::judge(const Problem& problem) {
  extract(problem);
  return evaluate(problem);
}

// Judges and refines the point of the core; true when nothing is left but rounding.
bool DenseSolver::Impl::refine(const Problem& problem) {
  double error = judge(problem);
  for (int k = 0; k < kMaxRefinements && error > kRounding; ++k) {
    core_.correct(judge_.stationarity().data());
    const double corrected = judge(problem);
    if (!(corrected < error)) {
      core_.revert();
      error = judge(problem);
      break;
    }
    error = corrected;
  }
  return error <= kRounding;
}

Status DenseSolver::Impl::iterate(const Problem& problem, const Options& options) {
  using Outcome = DualActiveSet::Outcome;
  core_.bind(&constraints_, &cholesky_);
  set_gradient(problem);
  if (core_.build(guess_.data(), options.tolerance) == Outcome::infeasible) {
    judge(problem);
    return Status::infeasible;
  }
  core_.restart();
  double best = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kMaxRounds; ++round) {
    const Outcome outcome = core_.run(options.max_iterations, options.tolerance, &iterations_);
    if (outcome != Outcome::optimal) {
      const bool good = judge(problem) <= options.tolerance;
      if (good) return Status::solved;
      return outcome == Outcome::infeasible ? Status::infeasible : Status::max_iterations;
    }
    const bool done = refine(problem);
    const double error = residuals_.scaled.max();
    if (done || (error <= options.tolerance && (!proximal_ || !(error < 0.5 * best)))) {
      return Status::solved;
    }
    if (std::isnan(error)) return Status::max_iterations;
    best = std::min(best, error);
    if (proximal_) {
      if (round % kPatientRounds == kPatientRounds - 1) {
        shift_ *= 0.1;
        if (!cholesky_.factor(problem.H, shift_.data(), kSingularPivot)) break;
      }
      set_gradient(problem);
    }
    // Factor the working set afresh: updates may have lost accuracy.
    std::fill_n(guess_.begin(), constraints_.size(), std::int8_t{0});
    for (int k = 0; k < core_.size(); ++k) {
      if (core_.is_inequality(k)) guess_[core_.id(k)] = core_.sign(k) > 0.0 ? -1 : 1;
    }
    if (iterations_ >= options.max_iterations) break;
    ++iterations_;
    core_.build(guess_.data(), options.tolerance);
    core_.restart();
  }
  return residuals_.scaled.max() <= options.tolerance ? Status::solved : Status::max_iterations;
}

Result DenseSolver::Impl::finish(const Problem& problem, Status status) {
  const auto [n, p, m] = problem.dimensions();
  std::fill_n(row_sides_.begin(), m, Side::none);
  std::fill_n(bound_sides_.begin(), n, Side::none);
  const bool has_set = status == Status::solved || status == Status::max_iterations;
  for (int k = 0; has_set && k < core_.size(); ++k) {
    if (!core_.is_inequality(k)) continue;
    const int id = core_.id(k);
    Side* side = constraints_.is_bound(id) ? &bound_sides_[constraints_.unknown_of(id)]
                                           : &row_sides_[id - p];
    *side = core_.sign(k) > 0.0 ? Side::lower : Side::upper;
  }
  known_rows_ = has_set ? m : 0;
  known_bounds_ = has_set ? n : 0;

  Result result;
  result.status = status;
  result.iterations = iterations_;
  result.objective = judge_.objective();
  result.residuals = residuals_;
  result.x = {x_.data(), n};
  result.y = {y_.data(), p};
  result.z = {z_.data(), m};
  result.w = {w_.data(), n};
  result.active = {{row_sides_.data(), static_cast<std::size_t>(m)},
                   {bound_sides_.data(), static_cast<std::size_t>(n)}};
  return result;
}

// Loads, checks and factors the problem; a status when it cannot be solved as it stands.
std::optional<Status> DenseSolver::Impl::load(const Problem& problem, double tolerance) {
  using Check = ConstraintSet::Check;
  const Check check = constraints_.load(problem, tolerance);
  if (check == Check::non_finite || !finite_cost(problem)) return Status::non_finite;
  if (check == Check::infeasible) return Status::infeasible;
  if (!factor(problem)) return Status::non_convex;
  return std::nullopt;
}

Result DenseSolver::Impl::solve(const Problem& problem, const Options& options) {
  if (!problem.consistent() || !fits(problem.dimensions(), max_)) return {};
  iterations_ = 0;
  for (auto* v : {&x_, &y_, &z_, &w_}) v->setZero();
  const std::optional<Status> refused = load(problem, options.tolerance);
  if (refused) {
    evaluate(problem);
    return finish(problem, *refused);
  }
  make_guess(options);
  return finish(problem, iterate(problem, options));
}

DenseSolver::DenseSolver(const Dimensions& max)
    : impl_(std::make_unique<Impl>(at_least_zero(max))) {}
DenseSolver::~DenseSolver() = default;
DenseSolver::DenseSolver(DenseSolver&&) noexcept = default;
DenseSolver& DenseSolver::operator=(DenseSolver&&) noexcept = default;

Result DenseSolver::solve(const Problem& problem, const Options& options) {
  return impl_->solve(problem, options);
}

void DenseSolver::reset_warm_start() { impl_->reset_warm_start(); }

const Dimensions& DenseSolver::max_dimensions() const { return impl_->max(); }

}  // namespace gaitd::qp
