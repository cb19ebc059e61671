// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/leg_configuration.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"

namespace gaitd::walking {
namespace {

constexpr double kShortestStep = 1e-3;  // m, that has a direction
constexpr double kStraightened = 0.01;  // rad, from the straight knee
// Leg lengths, of the hip from mid-stance to touchdown: a leg that stands straight lets it come
// down no further before the other foot is on the ground.
constexpr double kLargestDrop = 0.25;

}  // namespace

void LegConfiguration::set_leg(const GaitdModel& model, int side, double hip_ahead) {
  leg_ = LegGeometry(model, side);
  scale_ = GaitScale(model);
  hip_ahead_ = hip_ahead;
  separation_ = model.nominal_foot_separation;
}

double LegConfiguration::straightest(int side, const GaitdGaitState& gait,
                                     const LegParameters& p) const {
  const double straight = p[Legs::kStraightKnee];
  const bool stands = gait.phase != GAITD_PHASE_STAND && gait.transfer_final == 0 &&
                      gait.footstep_count > 0 && gait.next_side != side;
  if (!stands) return straight;
  const GaitdPose& foothold = gait.footholds[side].pose;
  const double yaw = sdk::yaw_of(sdk::quaternion(foothold.orientation));
  const Eigen::Vector3d step = sdk::from_yaw(-yaw) * (sdk::view(gait.adjusted[0].pose.position) -
                                                      sdk::view(foothold.position));
  const double sideways = std::max(0.0, std::abs(step.y()) - separation_);
  const double horizontal = std::hypot(step.x(), sideways);
  // The CoM passes the middle between the feet half-way through the transfer that follows.
  const double swing = gait.adjusted[0].swing_duration;
  const double transfer =
      gait.footstep_count > 1 ? gait.adjusted[1].transfer_duration : gait.final_transfer_duration;
  const double progress = 0.5 - 0.5 * std::min(0.5, transfer / (swing + transfer));
  const double along = step.x() / std::max(horizontal, kShortestStep);
  const double hip = progress * horizontal + along * hip_ahead_;
  return straightest_knee(leg_, horizontal, hip, straight, kLargestDrop * leg_.length(0.0));
}

// The state that the gait asks for, given the one the leg is in.
LegState LegConfiguration::next_state(bool straightened, bool lowered, int side,
                                      const GaitdGaitState& gait) const {
  const double fraction =
      gait.phase_duration > 0.0 ? gait.time_in_phase / gait.phase_duration : 0.0;
  if (gait.phase == GAITD_PHASE_SWING) {
    if (gait.next_side == side) {
      return fraction < kExtendFraction ? LegState::kBent : LegState::kExtend;
    }
    if (fraction >= kCollapseFraction || lowered) return LegState::kCollapsed;
  } else if (gait.phase == GAITD_PHASE_TRANSFER && gait.transfer_final == 0 &&
             gait.trailing_side == side) {
    return LegState::kCollapsed;
  }
  const LegState state = reference_.state;
  if (state == LegState::kStraight) return state;
  return state == LegState::kStraighten && straightened ? LegState::kStraight
                                                        : LegState::kStraighten;
}

void LegConfiguration::reset(double knee) {
  reference_.state = LegState::kBent;
  reference_.knee = knee;
  stance_.reset(knee);
}

void LegConfiguration::follow(double dt, double target, double rate, double knee) {
  const double shortening = leg_.shortening(stance_.value());
  stance_.update(dt, target, rate / scale_.time, kRise * scale_.speed / shortening);
  reference_.acceleration = stance_.acceleration();
  if (stance_.value() < knee - kMaxLead) {
    stance_.reset(knee - kMaxLead, stance_.velocity());
    reference_.acceleration = 0.0;
  }
  reference_.knee = stance_.value();
  reference_.rate = stance_.velocity();
}

const LegConfiguration::Reference& LegConfiguration::update(
    double dt, int side, double knee, double rate, const ReferenceFilter& lowering, double deepest,
    const GaitdGaitState& gait, const LegParameters& p) {
  const double straight = straightest(side, gait, p);
  reference_.rate = reference_.acceleration = 0.0;
  // A leg that did not carry begins where it is.
  const LegState before = reference_.state;
  const bool swung = before == LegState::kBent || before == LegState::kExtend;
  if (swung || gait.mode != mode_) stance_.reset(knee, rate);
  mode_ = gait.mode;
  const bool straightened = stance_.value() <= straight + kStraightened;
  const bool lowered = lowering.value() > p[Legs::kCollapsedKnee];
  reference_.state = next_state(straightened, lowered, side, gait);
  const double pace = gait.phase == GAITD_PHASE_STAND ? kSettleRate : kStanceRate;

  if (gait.mode != GAITD_MODE_WALK_STRAIGHT) {
    // The commanded height bends a leg that carries the robot; only the others need to be told. And
    // one that is straight: it is as long as it can be, and no task knows that it may bend.
    const bool leaving =
        gait.phase != GAITD_PHASE_STAND && gait.transfer_final == 0 && gait.next_side == side;
    const double landing = kLandingKnee * p[Legs::kBentKnee], bend = std::max(knee, 0.0);
    const double stretched = bend < landing ? 1.0 - bend / landing : 0.0;
    reference_ = {reference_.state,
                  p[Legs::kBentKnee],
                  kBentGains.stiffness,
                  kBentGains.damping,
                  kBentGains.weight,
                  0.0,
                  0.0};
    if (leaving || stretched <= 0.0) stance_.reset(knee, rate);
    if (!leaving) {
      reference_.weight *= stretched;
      follow(dt, p[Legs::kBentKnee], pace, knee);
    }
    return reference_;
  }
  const Gains& gains = LegConfiguration::gains(reference_.state);
  reference_.stiffness = gains.stiffness;
  reference_.damping = gains.damping;
  reference_.weight = gains.weight;
  switch (reference_.state) {
    case LegState::kStraighten:
    case LegState::kStraight:
      follow(dt, straight, pace, knee);
      break;
    case LegState::kCollapsed:
      if (gait.phase == GAITD_PHASE_SWING) {
        follow(dt, std::max(straight, p[Legs::kCollapsedKnee]), kStanceRate, knee);
      } else {
        // Hip and toe say how long a trailing leg is; a knee of its own would drag the toe. So it
        // bends as it likes, and is only kept from straightening.
        reference_.knee = std::max(knee, p[Legs::kCollapsedKnee]);
        reference_.rate = std::max(rate, 0.0);
        stance_.reset(knee, rate);
      }
      break;
    case LegState::kBent:
      reference_.knee = p[Legs::kSwingKnee];
      break;
    case LegState::kExtend:
      reference_.knee = p[Legs::kStraightKnee];
      break;
  }
  // The leg that stands gives way where the other one has to reach.
  const double lower = std::min(lowering.value(), deepest);
  if (gait.next_side != side && lower > std::max(reference_.knee, p[Legs::kStraightKnee])) {
    const bool lowered_to_stop = lowering.value() > deepest;
    reference_.knee = lowered_to_stop ? deepest : lowering.value();
    reference_.rate = lowered_to_stop ? 0.0 : lowering.velocity();
    reference_.acceleration = lowered_to_stop ? 0.0 : lowering.acceleration();
  }
  return reference_;
}

}  // namespace gaitd::walking
