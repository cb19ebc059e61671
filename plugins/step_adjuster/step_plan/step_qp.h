// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "capture_set.h"
#include "gaitd/qp/dense_solver.h"
#include "gaitd/walking/icp_feedback.h"
#include "gaitd/walking/polygon.h"

namespace gaitd::plugins {

// normal . p >= offset
struct HalfPlane {
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
  double offset = 0.0;
};

// A later phase of the step, of known duration: a CMP moved by q in all of it takes `share` q off
// the ICP error at touchdown.
struct LaterPhase {
  double share = 0.0;
  double left = 0.0;  // of an error that the feedback leaves, where nothing bounds it
  Eigen::Vector2d cmp = Eigen::Vector2d::Zero();  // constant one that the plan amounts to
  walking::ConvexPolygon region;                  // for the CMP, around that one; empty: it stays
  bool free() const { return share > 0.0 && region.size() >= 3; }
  // The CMP that is moved by what the feedback makes of this error (m).
  Eigen::Vector2d moved(const Eigen::Vector2d& error) const;
};

// What is left of a step, in the world frame (m, s): of the swing, or of the transfer before it
// and the swing.
struct StepProblem {
  enum {
    kSwing,
    kTransfer,
    kLater
  };  // the swing after this transfer, the transfer after touchdown
  double omega = 3.0;
  double kappa = 1.0;
  Eigen::Vector2d com, icp;     // measured
  Eigen::Vector2d cmp;          // of this phase: constant one that the plan amounts to
  Eigen::Vector2d icp_end;      // of the plan at touchdown, with shift D0
  double gamma = 1.0;           // d icp_end / d shift
  Eigen::Vector2d commanded;    // foothold
  Eigen::Vector2d start_shift;  // D0, with which the swing began
  Eigen::Vector2d foot;         // where the swing foot is
  walking::ConvexPolygon cmp_region;
  walking::ConvexPolygon reach;
  walking::ConvexPolygon landing;  // where the terrain allows it; empty: anywhere
  HalfPlane clear;                 // of the stance foot, on the way too
  CaptureSet capture;
  double growth = 1.0;  // of an ICP error from the end of this phase to touchdown
  std::array<LaterPhase, kLater> later;
  double planned = 0.0;   // left of the commanded duration of this phase
  double shortest = 0.0;  // that may be left
  double longest = 0.0;
  double foot_speed = 0.0;  // m/s, mean, of the way that is left
  double swing = 0.0;       // s, after this phase
  bool held = false;        // the foothold stays where it was decided to be

  Eigen::Vector2d ecmp() const { return walking::ecmp_of(cmp, com, kappa); }
  // What the plan misses at touchdown with the best constant CMPs and this shift, when this phase
  // ends after `remaining` seconds (m).
  Eigen::Vector2d missed(const Eigen::Vector2d& shift, double remaining) const;
};

struct StepWeights {
  double cmp;     // of a moved CMP, before and after touchdown, against a foothold moved as far
  double change;  // of a change of what was decided before, likewise
  double time;    // m^2/s^2, of an earlier or later touchdown: the way of the foot in that time
  double time_change;  // m^2/s^2, of a change of what was decided before
  double missed;       // of the ICP missed at touchdown
};

// Place of the next foothold, end of this phase and CMP of this and later phases, from one convex
// QP. With the growth tau = exp(w T) and m = (tau - 1) d as unknowns the ICP at the end of the
// phase is linear,
//   xi_T = r + tau (xi - r) - m,
// and so is the CMP r + d in the support polygon (the time as an unknown: Khadiv et al. 2016).
// CMPs of later phases are moved by q_k.
//   min  |D - D0|^2 + w_c (|m / (tau' - 1)|^2 + sum |q_k|^2) + w_t (T - T0)^2 + w_e |e|^2
//        + w_v |v|^2 + changes
//   s.t. e = growth xi_T - (growth - 1) r_1 - sum s_k q_k - xi_end - gamma (D - D0)
//        e + xi_end + gamma (D - D0) - foothold - v in the capture set
//        foothold in reach, allowed, clear of the stance foot, and not too fast to be reached
// tau' is the tau of before.
class StepQp {
 public:
  StepQp();
  // From the decision so far; false when there is no better one, and `shift` and `remaining` are
  // left alone then.
  bool solve(const StepProblem& problem, const StepWeights& weights, Eigen::Vector2d& shift,
             double& remaining);

 private:
  static constexpr int kUnknowns = 11;  // D, m, v, q, tau / tau' - 1
  static constexpr int kSpeedDirections = 8;
  static constexpr int kTangents = 4;
  static constexpr int kRows = 5 * walking::ConvexPolygon::kCapacity + CaptureSet::kDirections +
                               kTangents * kSpeedDirections + 1;
  using Row = Eigen::Matrix<double, 1, kUnknowns>;

  void add(const Row& row, double least);  // row . x >= least
  void add_foothold_rows(const walking::ConvexPolygon& polygon, const Eigen::Vector2d& commanded);
  void fill(const StepProblem& p, const StepWeights& w, const Eigen::Vector2d& shift,
            double remaining);

  qp::DenseSolver solver_;
  Eigen::Matrix<double, kUnknowns, kUnknowns> H_;
  Eigen::Matrix<double, kUnknowns, 1> g_, lower_, upper_;
  Eigen::Matrix<double, kRows, kUnknowns> C_;
  Eigen::Matrix<double, kRows, 1> l_, u_;
  int rows_ = 0;
};

}  // namespace gaitd::plugins
