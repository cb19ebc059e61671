// SPDX-License-Identifier: Apache-2.0
#include "capture_step.h"

#include <cmath>
#include <limits>

namespace gaitd::plugins {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kShortestEdge = 1e-9;  // m

}  // namespace

Eigen::Vector2d Capture::needed_shift(double remaining) const {
  const double growth = std::exp(omega * remaining);
  Eigen::Vector2d ecmp = ecmp_of(cmp);
  if (growth > 1.0 + 1e-6) {
    const Eigen::Vector2d ideal = (growth * icp - icp_end) / (growth - 1.0);
    ecmp = ecmp_of(cmp_region.closest_point(cmp_of(ideal)));
  }
  return start_shift + (ecmp + growth * (icp - ecmp) - icp_end) / gamma_end;
}

Eigen::Vector2d Capture::possible_shift(const Eigen::Vector2d& shift) const {
  const Eigen::Vector2d reached = reach.closest_point(commanded + shift);
  return (landing.empty() ? reached : landing.closest_point(reached)) - commanded;
}

CaptureQp::CaptureQp() : solver_({kUnknowns, 0, kRows}) {}

void CaptureQp::add_rows(const walking::ConvexPolygon& polygon, const Eigen::Vector2d& offset,
                         int column) {
  const int n = polygon.size();
  if (n < 3) return;
  for (int i = 0; i < n && rows_ < kRows; ++i) {
    const Eigen::Vector2d edge = polygon.vertex((i + 1) % n) - polygon.vertex(i);
    const double length = edge.norm();
    if (length < kShortestEdge) continue;
    const Eigen::Vector2d inwards(-edge.y() / length, edge.x() / length);
    C_.row(rows_).setZero();
    C_(rows_, column) = inwards.x();
    C_(rows_, column + 1) = inwards.y();
    l_[rows_] = inwards.dot(polygon.vertex(i) - offset);
    u_[rows_] = kInfinity;
    ++rows_;
  }
}

bool CaptureQp::solve(const Capture& c, const CaptureWeights& w, double remaining,
                      const Eigen::Vector2d& previous, Eigen::Vector2d& shift) {
  const double growth = std::exp(c.omega * remaining);
  const double lever = (growth - 1.0) / c.kappa;  // d xi_T / d cmp = -lever
  const Eigen::Vector2d ecmp = c.ecmp_of(c.cmp);
  const Eigen::Vector2d miss = ecmp + growth * (c.icp - ecmp) - c.icp_end;
  H_.setZero();
  for (int k = 0; k < 2; ++k) {
    // s = miss - lever (d_cmp + d_am) - gamma (D - D0), along axis k
    const double gradient[3] = {-c.gamma_end, -lever, -lever};
    const double rest = miss[k] + c.gamma_end * c.start_shift[k];
    const double cost[3] = {w.shift + w.change, w.cmp, w.angular};
    const double pull[3] = {w.shift * c.start_shift[k] + w.change * previous[k], 0.0, 0.0};
    for (int i = 0; i < 3; ++i) {
      const int row = 2 * i + k;
      g_[row] = w.slack * rest * gradient[i] - pull[i];
      for (int j = 0; j < 3; ++j) H_(row, 2 * j + k) = w.slack * gradient[i] * gradient[j];
      H_(row, row) += cost[i];
    }
  }
  rows_ = 0;
  add_rows(c.reach, c.commanded, 0);
  add_rows(c.landing, c.commanded, 0);
  add_rows(c.cmp_region, c.cmp, 2);
  lower_.setConstant(-kInfinity);
  upper_.setConstant(kInfinity);
  lower_.tail<2>().setConstant(-w.excursion);
  upper_.tail<2>().setConstant(w.excursion);
  qp::Problem problem;
  problem.H = H_;
  problem.g = g_;
  problem.C = C_.topRows(rows_);
  problem.l = qp::VectorView(l_.data(), rows_);
  problem.u = qp::VectorView(u_.data(), rows_);
  problem.lb = lower_;
  problem.ub = upper_;
  const qp::Result result = solver_.solve(problem);
  if (!result.solved()) return false;
  shift = {result.x[0], result.x[1]};
  return true;
}

}  // namespace gaitd::plugins
