// SPDX-License-Identifier: Apache-2.0
#include "step_qp.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gaitd::plugins {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kShortestEdge = 1e-9;  // m
constexpr double kLeastGrowth = 1e-6;   // of the ICP error, below which no CMP changes anything
// A robot that cannot be caught any more is worth any shift.
constexpr double kLostWeight = 1e4;
enum { kShift = 0, kMoment = 2, kLost = 4, kLater = 6, kTau = 10 };

Eigen::Vector2d inwards(const walking::ConvexPolygon& polygon, int i, double& length) {
  const Eigen::Vector2d edge = polygon.vertex((i + 1) % polygon.size()) - polygon.vertex(i);
  length = edge.norm();
  return {-edge.y() / length, edge.x() / length};
}

}  // namespace

Eigen::Vector2d StepProblem::missed(const Eigen::Vector2d& shift, double remaining) const {
  const double growth = std::exp(omega * remaining);
  const Eigen::Vector2d end = icp_end + gamma * (shift - start_shift);
  Eigen::Vector2d best = ecmp();
  if (growth > 1.0 + kLeastGrowth) {
    // The end of this phase from where the later ones as planned lead to the end of the step.
    const Eigen::Vector2d goal = (end + later[kSwing].share * later[kSwing].cmp) / this->growth;
    const Eigen::Vector2d ideal = (growth * icp - goal) / (growth - 1.0);
    const Eigen::Vector2d inside = cmp_region.closest_point(walking::cmp_of(ideal, com, kappa));
    best = walking::ecmp_of(inside, com, kappa);
  }
  Eigen::Vector2d error =
      this->growth * (best + growth * (icp - best)) - later[kSwing].share * later[kSwing].cmp - end;
  for (const LaterPhase& phase : later) {
    if (phase.free()) error -= phase.share * (phase.moved(error) - phase.cmp);
  }
  return error;
}

Eigen::Vector2d LaterPhase::moved(const Eigen::Vector2d& error) const {
  return region.closest_point(cmp + (1.0 - left) / share * error);
}

StepQp::StepQp() : solver_({kUnknowns, 0, kRows}) {}

void StepQp::add(const Row& row, double least) {
  if (rows_ == kRows) return;
  C_.row(rows_) = row;
  l_[rows_] = least;
  u_[rows_] = kInfinity;
  ++rows_;
}

void StepQp::add_foothold_rows(const walking::ConvexPolygon& polygon,
                               const Eigen::Vector2d& commanded) {
  for (int i = 0; polygon.size() >= 3 && i < polygon.size(); ++i) {
    double length;
    const Eigen::Vector2d n = inwards(polygon, i, length);
    if (length < kShortestEdge) continue;
    Row row = Row::Zero();
    row.segment<2>(kShift) = n.transpose();
    add(row, n.dot(polygon.vertex(i) - commanded));
  }
}

void StepQp::fill(const StepProblem& p, const StepWeights& w, const Eigen::Vector2d& shift,
                  double remaining) {
  const double tau = std::exp(p.omega * remaining);
  const double lever = std::max(tau - 1.0, kLeastGrowth);
  const Eigen::Vector2d ecmp = p.ecmp();
  const LaterPhase& swing = p.later[StepProblem::kSwing];
  const Eigen::Vector2d grown = p.growth * tau * (p.icp - ecmp);  // d xi / d (tau / tau')
  const Eigen::Vector2d reached = p.growth * ecmp + grown - swing.share * swing.cmp;
  const Eigen::Vector2d miss = reached - p.icp_end + p.gamma * p.start_shift;

  H_.setZero();
  g_.setZero();
  for (int k = 0; k < 2; ++k) {
    // e = miss - gamma D - growth m - sum s q + grown t, along axis k
    Row e = Row::Zero();
    e[kShift + k] = -p.gamma;
    e[kMoment + k] = -p.growth;
    for (int j = 0; j < StepProblem::kLater; ++j) e[kLater + 2 * j + k] = -p.later[j].share;
    e[kTau] = grown[k];
    H_ += w.missed * e.transpose() * e;
    g_ += w.missed * miss[k] * e.transpose();
    H_(kShift + k, kShift + k) += 1.0 + w.change;
    g_[kShift + k] -= p.start_shift[k] + w.change * shift[k];
    // The less time, the less a CMP elsewhere costs: 1 - exp(-w T) of it.
    H_(kMoment + k, kMoment + k) += w.cmp / (lever * tau);
    for (int j = 0; j < StepProblem::kLater; ++j) {
      // With it the best q leaves the share `left` of e where no bound holds it.
      const LaterPhase& later = p.later[j];
      const double law = later.free() ? later.left / (1.0 - later.left) : 0.0;
      H_(kLater + 2 * j + k, kLater + 2 * j + k) +=
          w.cmp + w.missed * later.share * later.share * law;
    }
    H_(kLost + k, kLost + k) += kLostWeight;
  }
  // T = remaining + t / w
  const double per_tau = 1.0 / (p.omega * p.omega);
  H_(kTau, kTau) += (w.time + w.time_change) * per_tau;
  g_[kTau] += w.time * (remaining - p.planned) / p.omega;

  rows_ = 0;
  add_foothold_rows(p.reach, p.commanded);
  add_foothold_rows(p.landing, p.commanded);
  Row row = Row::Zero();
  row.segment<2>(kShift) = p.clear.normal.transpose();
  add(row, p.clear.offset - p.clear.normal.dot(p.commanded));
  for (int i = 0; p.cmp_region.size() >= 3 && i < p.cmp_region.size(); ++i) {
    double length;
    const Eigen::Vector2d n = inwards(p.cmp_region, i, length);
    if (length < kShortestEdge) continue;
    const double room = n.dot(p.cmp - p.cmp_region.vertex(i));  // >= 0
    row.setZero();
    row.segment<2>(kMoment) = p.kappa * n.transpose();
    row[kTau] = tau * room;
    add(row, -lever * room);
  }
  for (int j = 0; j < StepProblem::kLater; ++j) {
    const walking::ConvexPolygon& region = p.later[j].region;
    for (int i = 0; p.later[j].free() && i < region.size(); ++i) {
      double length;
      const Eigen::Vector2d n = inwards(region, i, length);
      if (length < kShortestEdge) continue;
      row.setZero();
      row.segment<2>(kLater + 2 * j) = n.transpose();
      add(row, n.dot(region.vertex(i) - p.later[j].cmp));
    }
  }
  for (int i = 0; i < CaptureSet::kDirections; ++i) {
    const Eigen::Vector2d n = CaptureSet::direction(i);
    row.setZero();
    row.segment<2>(kShift) = n.transpose();
    row.segment<2>(kMoment) = p.growth * n.transpose();
    // A robot at the edge of what can be caught spends no time in the transfer after touchdown.
    row.segment<2>(kLater + 2 * StepProblem::kSwing) = swing.share * n.transpose();
    row.segment<2>(kLost) = n.transpose();
    row[kTau] = -n.dot(grown);
    add(row, n.dot(reached - p.commanded) - p.capture.limit[i]);
  }
  // |foothold - foot| <= v T. A foot that has to be faster already may keep its speed. T is concave
  // in tau: its tangents at a few times, evenly spaced, let it be a hundredth of a second faster.
  const bool to_come = p.swing > 0.0;  // its duration is known
  const double speed = std::max(
      p.foot_speed, (p.commanded + shift - p.foot).norm() / (to_come ? p.swing : remaining));
  const int tangents = to_come ? 1 : kTangents;
  for (int k = 0; k < tangents; ++k) {
    const double time = p.shortest + (p.longest - p.shortest) * k / (kTangents - 1);
    const double at = std::exp(p.omega * time);
    for (int i = 0; i < kSpeedDirections; ++i) {
      const double angle = 2.0 * M_PI * i / kSpeedDirections;
      const Eigen::Vector2d n(std::cos(angle), std::sin(angle));
      row.setZero();
      row.segment<2>(kShift) = -n.transpose();
      double way = speed * p.swing;
      if (!to_come) {
        row[kTau] = speed * tau / (at * p.omega);
        way = speed * (time + (tau - at) / (at * p.omega));
      }
      add(row, n.dot(p.commanded - p.foot) - way);
    }
  }
  lower_.setConstant(-kInfinity);
  upper_.setConstant(kInfinity);
  if (p.held) lower_.segment<2>(kShift) = upper_.segment<2>(kShift) = shift;
  for (int j = 0; j < StepProblem::kLater; ++j) {
    if (p.later[j].free()) continue;
    lower_.segment<2>(kLater + 2 * j).setZero();
    upper_.segment<2>(kLater + 2 * j).setZero();
  }
  lower_[kTau] = std::min(0.0, std::exp(p.omega * (p.shortest - remaining)) - 1.0);
  upper_[kTau] = std::max(0.0, std::exp(p.omega * (p.longest - remaining)) - 1.0);
}

bool StepQp::solve(const StepProblem& p, const StepWeights& w, Eigen::Vector2d& shift,
                   double& remaining) {
  fill(p, w, shift, remaining);
  qp::Problem problem;
  problem.H = H_;
  problem.g = g_;
  problem.C = C_.topRows(rows_);
  problem.l = qp::VectorView(l_.data(), rows_);
  problem.u = qp::VectorView(u_.data(), rows_);
  problem.lb = lower_;
  problem.ub = upper_;
  qp::Options options;
  options.warm_start = false;
  const qp::Result result = solver_.solve(problem, options);
  if (!result.solved()) return false;
  shift = {result.x[kShift], result.x[kShift + 1]};
  remaining += std::log1p(result.x[kTau]) / p.omega;
  return true;
}

}  // namespace gaitd::plugins
