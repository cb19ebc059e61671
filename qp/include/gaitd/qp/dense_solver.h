// SPDX-License-Identifier: Apache-2.0
#ifndef GAITD_QP_DENSE_SOLVER_H_
#define GAITD_QP_DENSE_SOLVER_H_

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>

#include "gaitd/qp/kkt.h"
#include "gaitd/qp/problem.h"

namespace gaitd::qp {

enum class Status : std::uint8_t {
  solved,              ///< every scaled KKT residual of the returned point is within tolerance
  max_iterations,      ///< not solved within the limits; also the end of an unbounded problem
  infeasible,          ///< the constraints contradict each other (certificate checked)
  non_finite,          ///< NaN or infinity in H, g, A, b, C, or NaN in a bound
  non_convex,          ///< H is not positive semi-definite
  invalid_dimensions,  ///< views of sizes that do not fit together or exceed the maxima
};

/// Name of a status, for logs.
const char* to_string(Status status);

/// Which side of a two-sided constraint is active.
enum class Side : std::int8_t { lower = -1, none = 0, upper = 1 };

/// A guess of the active set, or the one found. Entries beyond the sizes are ignored, missing
/// entries count as `none`. Equalities need not be given.
struct ActiveSet {
  std::span<const Side> inequalities;  ///< per row of C
  std::span<const Side> bounds;        ///< per unknown

  bool empty() const { return inequalities.empty() && bounds.empty(); }
};

struct Options {
  /// Largest number of changes of the working set. Each costs O(n (n + rows)) at most.
  int max_iterations = 1000;
  /// Bound on every entry of KktResiduals::scaled for `solved`.
  double tolerance = 1e-8;
  /// Start from the active set of the last solved problem, as far as it still fits.
  bool warm_start = true;
  /// If not empty, starts from this set instead. Any guess is safe; a wrong one costs time.
  ActiveSet guess;
};

/// What solve() found. The views point into the solver and hold until its next solve().
struct Result {
  Status status = Status::invalid_dimensions;
  int iterations = 0;      ///< changes of the working set
  double objective = 0.0;  ///< ½ xᵀHx + gᵀx
  KktResiduals residuals;  ///< of this point, against the problem as given
  VectorView x;            ///< n
  VectorView y;            ///< multipliers of A x = b; signs as in Point
  VectorView z;            ///< multipliers of l ≤ C x ≤ u
  VectorView w;            ///< multipliers of lb ≤ x ≤ ub
  ActiveSet active;        ///< working set at the end; `none` for equalities

  Point point() const { return {x, y, z, w}; }
  bool solved() const { return status == Status::solved; }
};

/// Dense solver for a Problem: dual active set method (Goldfarb & Idnani 1983), warm-started.
///
/// Exact: ends on a vertex of active sets with residuals near rounding, or says that it did not.
/// Linearly dependent equalities are dropped when consistent. A singular H is handled by the
/// proximal point method (Rockafellar 1976) around the same core, so the residuals are those of
/// the problem as given; the solution is then one of many. An unbounded problem ends as
/// max_iterations. Whatever the status, x is finite unless the numbers overflow, and the residuals
/// tell how far it is from optimal.
///
/// solve() never allocates, never throws, reads no clock, and gives bit-identical results for the
/// same history of calls. Not thread-safe; one solver per thread.
class DenseSolver {
 public:
  /// Allocates everything for problems up to `max`; negative sizes count as zero.
  explicit DenseSolver(const Dimensions& max);
  ~DenseSolver();
  DenseSolver(DenseSolver&&) noexcept;
  DenseSolver& operator=(DenseSolver&&) noexcept;

  /// Solves one problem. Sizes may change from call to call: the warm start then keeps the
  /// active sides of the leading rows and unknowns that both problems have.
  Result solve(const Problem& problem, const Options& options = {});

  /// Forgets the active set of the previous solve.
  void reset_warm_start();

  const Dimensions& max_dimensions() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gaitd::qp

#endif  // GAITD_QP_DENSE_SOLVER_H_
