// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gaitd/abi/types.h"
#include "gaitd/walking/com_height.h"
#include "gaitd/walking/gait_scale.h"
#include "gaitd/walking/leg_geometry.h"
#include "gaitd/walking/parameters.h"

namespace gaitd::walking {

using LegParameters = sdk::Parameters<Legs>;

enum class LegState { kStraighten = 0, kStraight, kCollapsed, kBent, kExtend };

// Privileged knee angle of one leg, from a small state machine (Griffin 2018; theory section 4):
//   straighten  touchdown of this leg: from the measured knee to the straight angle
//   straight    there; as straight as the coming step allows
//   collapsed   late in the other leg's swing and while trailing: slightly bent, more so when the
//               other foot comes down lower or later
//   bent        start of this leg's swing: picks the foot up
//   extend      later in this leg's swing: straight, reaching for the ground
// In walk-bent every state has the bent angle; a leg that carries goes there gently. Knee angles
// here are positive when bent.
class LegConfiguration {
 public:
  // How a knee is drawn to its reference: stiffness (1/s^2), damping (1/s), and a weight that lets
  // nothing but the tasks bend a straight leg, while one that swings only leans to it.
  struct Gains {
    double stiffness, damping, weight;
  };
  static constexpr Gains kBentGains{100.0, 6.0, 5.0};
  static constexpr Gains kStraightGains{80.0, 18.0, 150.0};
  static constexpr Gains kCollapsedGains{80.0, 18.0, 50.0};
  static constexpr Gains kExtendGains{80.0, 10.0, 5.0};
  static constexpr const Gains& gains(LegState state) {
    return state == LegState::kBent        ? kBentGains
           : state == LegState::kExtend    ? kExtendGains
           : state == LegState::kCollapsed ? kCollapsedGains
                                           : kStraightGains;
  }
  // sqrt(g/h), with which the knee of a leg that carries goes where it shall be, of a leg that
  // comes to stand alone and of a robot at rest: that of a critically damped filter.
  static constexpr double kStanceRate = 3.7;
  static constexpr double kSettleRate = 0.5;
  // sqrt(g h), with which a leg lifts the hip at most: up a stair the other one is still pushing.
  static constexpr double kRise = 0.07;
  // rad: no reference runs further ahead of a knee that something holds.
  static constexpr double kMaxLead = 0.2;
  // Of the knee of walk-bent: as straight as a leg may be there, when it lands.
  static constexpr double kLandingKnee = 0.5;
  // Parts of a swing after which its leg reaches out, and the one that stands gives way.
  static constexpr double kExtendFraction = 0.5;
  static constexpr double kCollapseFraction = 0.65;

  struct Reference {
    LegState state;
    double knee;       // rad, privileged
    double stiffness;  // 1/s^2
    double damping;    // 1/s
    double weight;
    double rate;          // rad/s, of that knee
    double acceleration;  // rad/s^2
  };

  // `hip_ahead` (m): of the hip over the ankle when the CoM is above the sole.
  void set_leg(const GaitdModel& model, int side, double hip_ahead);
  void reset(double knee);
  // `side` is this leg, `knee` and `rate` its measured bend (rad, rad/s). `lowering` (rad): the
  // bend at which the hip is low enough for the other leg, when this one stands, `deepest` the one
  // that its ankle allows. One call per tick of `dt` seconds.
  const Reference& update(double dt, int side, double knee, double rate,
                          const ReferenceFilter& lowering, double deepest,
                          const GaitdGaitState& gait, const LegParameters& parameters);
  const LegGeometry& geometry() const { return leg_; }
  const Reference& reference() const { return reference_; }

 private:
  LegState next_state(bool straightened, bool lowered, int side, const GaitdGaitState& gait) const;
  // Moves the knee of a leg that carries towards `target` (rad); `rate` in sqrt(g/h).
  void follow(double dt, double target, double rate, double knee);
  // rad: as straight as the next step allows this leg to stand.
  double straightest(int side, const GaitdGaitState& gait, const LegParameters& p) const;
  Reference reference_{LegState::kBent, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  LegGeometry leg_;
  double hip_ahead_ = 0.0;   // m
  double separation_ = 0.0;  // m, of the feet in the nominal posture
  GaitScale scale_{1.0, 1.0, 1.0};
  ReferenceFilter stance_;  // rad, the knee of a leg that carries
  int mode_ = GAITD_MODE_STAND;
};

}  // namespace gaitd::walking
