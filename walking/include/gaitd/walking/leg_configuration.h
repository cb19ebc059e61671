// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gaitd/abi/types.h"
#include "gaitd/walking/parameters.h"

namespace gaitd::walking {

using LegParameters = sdk::Parameters<Legs>;

enum class LegState { kStraighten = 0, kStraight, kCollapsed, kBent, kExtend };

// Privileged knee angle of one leg, from a small state machine (Griffin 2018; theory section 4):
//   straighten  touchdown of this leg: ramps from the measured knee to the straight angle
//   straight    ramp done
//   collapsed   late in the other leg's swing and while trailing: slightly bent
//   bent        start of this leg's swing: picks the foot up
//   extend      later in this leg's swing: straight, reaching for the ground
// In walk-bent every state has the bent angle. Knee angles here are positive when bent.
class LegConfiguration {
 public:
  struct Reference {
    LegState state;
    double knee;       // rad, privileged
    double stiffness;  // 1/s^2
    double damping;    // 1/s
    double weight;
  };

  void reset(double knee);
  // `side` is this leg, `knee` its measured bend (rad). One call per tick of `dt` seconds.
  const Reference& update(double dt, int side, double knee, const GaitdGaitState& gait,
                          const LegParameters& parameters);
  const Reference& reference() const { return reference_; }

 private:
  void enter(LegState state, double knee);
  Reference reference_{LegState::kBent, 0.0, 0.0, 0.0, 0.0};
  double time_in_state_ = 0.0;
  double knee_at_entry_ = 0.0;
  int mode_ = GAITD_MODE_STAND;
};

}  // namespace gaitd::walking
