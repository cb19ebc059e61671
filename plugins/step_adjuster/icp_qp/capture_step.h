// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "gaitd/qp/dense_solver.h"
#include "gaitd/walking/icp_feedback.h"
#include "gaitd/walking/polygon.h"

namespace gaitd::plugins {

// The end of one swing as the ICP sees it: with a constant CMP the ICP of now becomes
//   xi_T = r + A (xi - r),  A = exp(w T),  r = com - (com - cmp) / kappa
// and the walk goes on as planned if it lands where the plan, with the foothold moved by a shift D
// against the commanded one, wants it: xi_end + gamma_T (D - D0). World frame, m.
struct Capture {
  double omega = 3.0;
  double kappa = 1.0;
  Eigen::Vector2d com = Eigen::Vector2d::Zero();
  Eigen::Vector2d icp = Eigen::Vector2d::Zero();          // measured
  Eigen::Vector2d icp_end = Eigen::Vector2d::Zero();      // of the plan at touchdown with shift D0
  double gamma_end = 1.0;                                 // d icp_end / d shift
  Eigen::Vector2d cmp = Eigen::Vector2d::Zero();          // constant one that the plan amounts to
  Eigen::Vector2d commanded = Eigen::Vector2d::Zero();    // foothold
  Eigen::Vector2d start_shift = Eigen::Vector2d::Zero();  // D0, with which the swing began
  walking::ConvexPolygon cmp_region;                      // where the CMP may be
  walking::ConvexPolygon reach;                           // where the foothold may be
  walking::ConvexPolygon landing;  // where the terrain allows it; empty: anywhere

  Eigen::Vector2d ecmp_of(const Eigen::Vector2d& at) const {
    return walking::ecmp_of(at, com, kappa);
  }
  Eigen::Vector2d cmp_of(const Eigen::Vector2d& ecmp) const {
    return walking::cmp_of(ecmp, com, kappa);
  }
  // Shift that lands the ICP with the best constant CMP when `remaining` seconds are left,
  // whether it can be reached or not.
  Eigen::Vector2d needed_shift(double remaining) const;
  // The closest to it that reach and landing allow.
  Eigen::Vector2d possible_shift(const Eigen::Vector2d& shift) const;
};

struct CaptureWeights {
  double shift, cmp, angular, change, slack;
  double excursion;  // m, largest shift of the CMP by angular momentum
};

// The step adjustment QP (theory section 3, over what is left of the swing instead of one instant):
//   min  w_f|D - D0|^2 + w_c|d_cmp|^2 + w_a|d_am|^2 + w_r|D - D_prev|^2 + w_s|s|^2
//   s.t. s = xi_T(cmp + d_cmp + d_am) - xi_end - gamma_T (D - D0)
//        cmp + d_cmp in the support polygon, |d_am| bounded, foothold reachable and allowed
class CaptureQp {
 public:
  CaptureQp();
  // False when the problem has no solution; `shift` is unchanged then.
  bool solve(const Capture& capture, const CaptureWeights& weights, double remaining,
             const Eigen::Vector2d& previous, Eigen::Vector2d& shift);

 private:
  static constexpr int kUnknowns = 6;  // D, d_cmp, d_am
  static constexpr int kRows = 3 * walking::ConvexPolygon::kCapacity;
  // Half-planes that keep `offset + x(column..column+1)` inside the polygon.
  void add_rows(const walking::ConvexPolygon& polygon, const Eigen::Vector2d& offset, int column);

  qp::DenseSolver solver_;
  Eigen::Matrix<double, kUnknowns, kUnknowns> H_;
  Eigen::Matrix<double, kUnknowns, 1> g_, lower_, upper_;
  Eigen::Matrix<double, kRows, kUnknowns> C_;
  Eigen::Matrix<double, kRows, 1> l_, u_;
  int rows_ = 0;
};

}  // namespace gaitd::plugins
