// SPDX-License-Identifier: Apache-2.0
#ifndef GAITD_QP_KKT_H_
#define GAITD_QP_KKT_H_

#include <Eigen/Core>
#include <limits>

#include "gaitd/qp/problem.h"

namespace gaitd::qp {

/// A primal-dual point of a Problem. With the signs used here the stationarity condition reads
///
///     H x + g + Aᵀ y + Cᵀ z + w = 0,
///
/// z and w positive where the upper side holds x back, negative where the lower side does.
struct Point {
  VectorView x;  ///< n
  VectorView y;  ///< multipliers of A x = b
  VectorView z;  ///< multipliers of l ≤ C x ≤ u
  VectorView w;  ///< multipliers of lb ≤ x ≤ ub, length n
};

/// One figure per optimality condition, each the largest violation over its rows. Infinite until
/// computed.
struct KktNorms {
  static constexpr double kUnknown = std::numeric_limits<double>::infinity();

  double stationarity = kUnknown;       ///< ‖H x + g + Aᵀy + Cᵀz + w‖∞
  double primal_equality = kUnknown;    ///< ‖A x − b‖∞
  double primal_inequality = kUnknown;  ///< largest excess over l, u, lb, ub
  double dual_sign = kUnknown;          ///< largest multiplier that pushes from an infinite bound
  double complementarity = kUnknown;    ///< largest |multiplier · distance to its bound|

  /// The largest of the five; NaN if one of them is NaN.
  double max() const;
};

/// Violation of the optimality conditions (Nocedal & Wright 2006, section 16.4).
///
/// `scaled` divides each absolute figure by one plus the largest magnitude that went into it:
/// stationarity and dual sign by ‖Hx‖∞, ‖g‖∞, ‖Aᵀy‖∞, ‖Cᵀz‖∞, ‖w‖∞; primal equality by ‖Ax‖∞, ‖b‖∞;
/// primal inequality by ‖Cx‖∞ for rows, by |x_i| for bounds; complementarity by |xᵀHx|, |gᵀx|.
struct KktResiduals {
  KktNorms absolute;
  KktNorms scaled;
};

/// Computes KKT residuals straight from the problem data, sharing no state with a solver.
class KktJudge {
 public:
  /// Allocates for problems up to `max`; evaluate() never allocates.
  explicit KktJudge(const Dimensions& max);

  /// Residuals of `point`. The problem must be consistent(), not larger than `max`, and the sizes
  /// of the point must match it. NaN in the data or in the point gives NaN figures.
  KktResiduals evaluate(const Problem& problem, const Point& point);

  /// H x + g + Aᵀy + Cᵀz + w of the last evaluate(); the first n entries count.
  const Eigen::VectorXd& stationarity() const { return stationarity_; }
  /// ½ xᵀHx + gᵀx of the last evaluate().
  double objective() const { return objective_; }

 private:
  Eigen::VectorXd stationarity_;
  Eigen::VectorXd equality_;    // A x − b
  Eigen::VectorXd inequality_;  // C x
  double objective_ = 0.0;
};

}  // namespace gaitd::qp

#endif  // GAITD_QP_KKT_H_
