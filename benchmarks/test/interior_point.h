// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "gaitd/qp/problem.h"

namespace gaitd::benchmarks {

// Solves a strictly convex problem by Mehrotra's predictor and corrector (Nocedal & Wright 2006,
// section 16.6), dense and slow: a judge that shares nothing with the solver that it judges. Bounds
// may be infinite, but not equal to each other. Empty when it does not converge.
Eigen::VectorXd solve_by_interior_point(const qp::Problem& problem);

}  // namespace gaitd::benchmarks
