// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/leg_configuration.h"

#include <algorithm>

namespace gaitd::walking {
namespace {

// The state that the gait asks for, given the one the leg is in.
LegState next_state(LegState state, bool straightened, int side, const GaitdGaitState& gait,
                    const LegParameters& p) {
  const double fraction =
      gait.phase_duration > 0.0 ? gait.time_in_phase / gait.phase_duration : 0.0;
  if (gait.phase == GAITD_PHASE_SWING) {
    if (gait.next_side == side) {
      return fraction < p[Legs::kExtendFraction] ? LegState::kBent : LegState::kExtend;
    }
    if (fraction >= p[Legs::kCollapseFraction]) return LegState::kCollapsed;
  } else if (gait.phase == GAITD_PHASE_TRANSFER && gait.transfer_final == 0 &&
             gait.trailing_side == side) {
    return LegState::kCollapsed;
  }
  if (state == LegState::kStraight) return state;
  return state == LegState::kStraighten && straightened ? LegState::kStraight
                                                        : LegState::kStraighten;
}

}  // namespace

void LegConfiguration::reset(double knee) {
  reference_.knee = knee;
  enter(LegState::kBent, knee);
}

void LegConfiguration::enter(LegState state, double knee) {
  reference_.state = state;
  time_in_state_ = 0.0;
  knee_at_entry_ = knee;
}

const LegConfiguration::Reference& LegConfiguration::update(double dt, int side, double knee,
                                                            const GaitdGaitState& gait,
                                                            const LegParameters& p) {
  time_in_state_ += dt;
  const bool straightened = reference_.knee <= p[Legs::kStraightKnee] + 1e-9;
  const LegState wanted = next_state(reference_.state, straightened, side, gait, p);
  if (wanted != reference_.state) enter(wanted, knee);
  if (gait.mode != mode_) {
    mode_ = gait.mode;
    enter(LegState::kStraighten == wanted || LegState::kStraight == wanted ? LegState::kStraighten
                                                                           : wanted,
          knee);
  }

  if (gait.mode != GAITD_MODE_WALK_STRAIGHT) {
    // The commanded height bends a leg that carries the robot; only the others need to be told.
    const bool leaving =
        gait.phase != GAITD_PHASE_STAND && gait.transfer_final == 0 && gait.next_side == side;
    reference_ = {reference_.state, p[Legs::kBentKnee], p[Legs::kBentStiffness],
                  p[Legs::kBentDamping], leaving ? p[Legs::kBentWeight] : 0.0};
    return reference_;
  }
  const double straight = p[Legs::kStraightKnee];
  const bool soft = reference_.state == LegState::kBent || reference_.state == LegState::kCollapsed;
  reference_.stiffness = p[soft ? Legs::kBentStiffness : Legs::kStraightStiffness];
  reference_.damping = p[soft ? Legs::kBentDamping : Legs::kStraightDamping];
  reference_.weight = p[soft ? Legs::kBentWeight : Legs::kStraightWeight];
  switch (reference_.state) {
    case LegState::kStraighten: {
      const bool standing = gait.phase == GAITD_PHASE_STAND;
      const double rate = p[standing ? Legs::kSettleRate : Legs::kStraightenRate];
      const double ramp = knee_at_entry_ - rate * time_in_state_;
      reference_.knee = std::max({straight, ramp, knee - p[Legs::kMaxLead]});
      break;
    }
    case LegState::kCollapsed: {
      const double s = std::min(1.0, time_in_state_ / p[Legs::kCollapseDuration]);
      const double goal = p[Legs::kCollapsedKnee];
      const double start = std::max(straight, knee_at_entry_);
      reference_.knee = start + (goal - start) * s * s;
      break;
    }
    case LegState::kBent:
      reference_.knee = p[Legs::kSwingKnee];
      break;
    case LegState::kStraight:
    case LegState::kExtend:
      reference_.knee = straight;
      break;
  }
  return reference_;
}

}  // namespace gaitd::walking
