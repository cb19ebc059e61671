// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "gaitd/abi/plugin.h"
#include "gaitd/sdk/parameter.h"
#include "gaitd/walking/polygon.h"

namespace gaitd::walking {

enum class Feedback {
  kGainParallel,
  kGainOrthogonal,
  kGainStanding,
  kIntegralStanding,
  kIntegralLimit,
  kDirectionSpeed,
  kMargin,
  kExcursion,
  kKappaMin,
  kKappaMax,
  kKappaFilter,
  kDelay,
  kCount
};
inline constexpr std::array<GaitdParameter, 12> kFeedbackParameters = {
    sdk::real_parameter("gain_parallel", "1/s", 0, 30, 4, "ICP feedback along its motion"),
    sdk::real_parameter("gain_orthogonal", "1/s", 0, 30, 3, "ICP feedback across its motion"),
    sdk::real_parameter("gain_standing", "1/s", 0, 30, 3, "ICP feedback when standing"),
    sdk::real_parameter("integral_standing", "1/s", 0, 10, 0.5,
                        "integral feedback when standing; fades as fast in a walk"),
    sdk::real_parameter("integral_limit", "m", 0, 0.1, 0.03, "of the CMP by integral feedback"),
    sdk::real_parameter("direction_speed", "m/s", 0, 1, 0.05,
                        "slower references keep the last direction"),
    sdk::real_parameter("margin", "m", 0, 0.05, 0.01, "of the CMP to the edge of the polygon"),
    sdk::real_parameter("excursion", "m", 0, 0.3, 0.03,
                        "of the CMP out of the polygon, paid with angular momentum, in a walk"),
    sdk::real_parameter("kappa_min", "", 0.3, 1, 0.8, "clamp of kappa (theory section 1)"),
    sdk::real_parameter("kappa_max", "", 1, 3, 1.4, "clamp of kappa"),
    sdk::real_parameter("kappa_filter", "Hz", 0.1, 500, 10, "low-pass of kappa"),
    sdk::real_parameter("delay", "s", 0, 0.02, 0.0045,
                        "of sensors, commands and drives, over which the ICP is predicted"),
};

// CMP of an eCMP and back (W, m), for a CoM at `com` (theory section 1).
inline Eigen::Vector2d cmp_of(const Eigen::Vector2d& ecmp, const Eigen::Vector2d& com,
                              double kappa) {
  return com - kappa * (com - ecmp);
}
inline Eigen::Vector2d ecmp_of(const Eigen::Vector2d& cmp, const Eigen::Vector2d& com,
                               double kappa) {
  return com - (com - cmp) / kappa;
}
// Constant CMP that an ICP goes from `start` to `end` with, growing by `growth`.
inline Eigen::Vector2d planned_cmp(const Eigen::Vector2d& start, const Eigen::Vector2d& end,
                                   double growth) {
  return (growth * start - end) / (growth - 1.0);
}

// Tracks the ICP reference by moving the CMP (theory section 3):
//   r_eCMP = r_ref + (1 + k/w) (xi - xi_ref), k along and across the motion of the reference
// The CMP that follows is kept inside the support polygon plus a bounded excursion e, which takes
// angular momentum, when standing asked for as such: L' = m g (-e_y, e_x, 0) (theory section 1).
// Stepping, the next foothold is the better answer, and a trunk that swings disturbs it. What is
// commanded acts a known delay later: the error is the one of then, predicted with what is on its
// way.
class IcpFeedback {
 public:
  static constexpr double kStandingExcursion = 0.1;  // heights of the CoM
  explicit IcpFeedback(const GaitdModel& model) : model_(model) { reset(); }

  void set_parameter(int index, double value) { p_.set(index, value); }
  double operator[](Feedback p) const { return p_[p]; }
  void reset();
  void get_state(GaitdStepAdjusterState& s) const { s = state_; }
  void set_state(const GaitdStepAdjusterState& s) { state_ = s; }

  // One tick: kappa first, then the eCMP, CMP and momentum rate of `out`; `out` is overwritten.
  void update(const GaitdStepAdjusterInput& in, GaitdStepAdjustment& out);

  double kappa() const { return state_.kappa; }
  // Where the CMP may be without angular momentum: the support polygon less the margin, and what
  // handholds add (W, m).
  ConvexPolygon cmp_region(const GaitdGaitState& gait, const GaitdRobotState& robot) const;

 private:
  void update_kappa(const GaitdStepAdjusterInput& in);
  Eigen::Vector2d feedback(const GaitdStepAdjusterInput& in);
  // The ICP error when a command of now acts:
  //   e(t + d) = exp(w d) e - w int_0^d exp(w (d - s)) u(t - d + s) ds,  u = r_eCMP - r_ref
  Eigen::Vector2d predicted_error(const GaitdStepAdjusterInput& in) const;

  const GaitdModel model_;
  sdk::Parameters<Feedback> p_{kFeedbackParameters};
  GaitdStepAdjusterState state_{};
  static constexpr int kMaxOnTheirWay = 128;
  std::array<Eigen::Vector2d, kMaxOnTheirWay> commanded_;  // r_eCMP of the last ticks (m)
  int newest_ = 0;
  int commanded_count_ = 0;
};

}  // namespace gaitd::walking
