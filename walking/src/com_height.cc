// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/com_height.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"

namespace gaitd::walking {
namespace {

// Of a step, how far the hip is behind the foot that lands: a half and what the CoM still has to go
// in the transfer that follows.
constexpr double kLandingShare = 0.6;
constexpr double kRisenAt = 0.5;  // of a swing

// m, by how much the hip is lower than when standing for a leg to span `share` of the way between
// two footholds; negative where it could be higher.
double lowered(const GaitdPose& a, const GaitdPose& b, double share, const LegReach& r) {
  const Eigen::Vector3d d =
      sdk::quaternion(a.orientation).conjugate() * (sdk::view(b.position) - sdk::view(a.position));
  const double sideways = std::max(0.0, std::abs(d.y()) - r.nominal_separation);
  const double horizontal = share * std::hypot(d.x(), sideways);
  const double vertical = std::sqrt(std::max(0.0, r.longest * r.longest - horizontal * horizontal));
  return r.leg_length - vertical;
}

// How far the CoM must come down so that the trailing leg spans two footholds.
double drop(const GaitdPose& a, const GaitdPose& b, const LegReach& r) {
  return std::clamp(lowered(a, b, r.trailing_share, r), 0.0, r.largest_drop);
}

// How far the CoM must come down, over the foot that stands, so that the other leg reaches a lower
// foothold with its sole flat.
double landing_drop(const GaitdPose& stance, const GaitdPose& next, const LegReach& r) {
  const double below = stance.position[2] - next.position[2];
  if (below <= 0.0) return 0.0;
  return std::clamp(lowered(stance, next, kLandingShare, r) + below, 0.0, r.largest_drop + below);
}

// How far the CoM must come down, over `ground` (m, W), so that a lower trailing leg spans two
// footholds until lift-off.
double trailing_drop(const GaitdPose& trailing, const GaitdPose& leading, double ground,
                     const LegReach& r) {
  const double rise = leading.position[2] - trailing.position[2];
  if (rise <= 0.0) return 0.0;
  const double lower = lowered(trailing, leading, r.trailing_share, r) + rise;
  return std::clamp(lower, 0.0, r.largest_drop + rise) - (leading.position[2] - ground);
}

}  // namespace

double com_height_target(const GaitdGaitState& gait, const LegReach& reach) {
  const GaitdPose& left = gait.footholds[GAITD_LEFT].pose;
  const GaitdPose& right = gait.footholds[GAITD_RIGHT].pose;
  double ground = 0.5 * (left.position[2] + right.position[2]);
  double lower = drop(left, right, reach);
  const double share = gait.phase_duration > 0.0
                           ? std::clamp(gait.time_in_phase / gait.phase_duration, 0.0, 1.0)
                           : 1.0;
  if (gait.phase == GAITD_PHASE_TRANSFER && gait.transfer_final == 0 && gait.footstep_count > 0) {
    const GaitdPose& trailing = gait.footholds[gait.next_side].pose;
    const GaitdPose& leading = gait.footholds[other_side(gait.next_side)].pose;
    const double start = gait.trailing_side == GAITD_BOTH ? ground : trailing.position[2];
    ground = start + share * (leading.position[2] - start);
    lower = std::max(lower, share * drop(leading, gait.adjusted[0].pose, reach));
    if (gait.trailing_side != GAITD_BOTH) {
      lower = std::max(lower, (1.0 - share) * landing_drop(trailing, leading, reach));
    }
    lower = std::max(lower, trailing_drop(trailing, leading, ground, reach));
  } else if (gait.phase == GAITD_PHASE_TRANSFER && gait.trailing_side != GAITD_BOTH) {
    const GaitdPose& trailing = gait.footholds[gait.trailing_side].pose;
    const GaitdPose& leading = gait.footholds[other_side(gait.trailing_side)].pose;
    ground = trailing.position[2] + share * (ground - trailing.position[2]);
    lower = std::max(lower, (1.0 - share) * landing_drop(trailing, leading, reach));
  } else if (gait.phase == GAITD_PHASE_SWING) {
    const GaitdPose& stance = gait.footholds[gait.support].pose;
    ground = stance.position[2];
    const GaitdPose& trailing = gait.footholds[gait.next_side].pose;
    lower = std::max(lower, trailing_drop(trailing, stance, ground, reach));
    // Low enough for the step that is coming, never waiting for it; up again before the swing foot
    // comes to the edge of a stair.
    const double left = std::max(0.0, 1.0 - share / kRisenAt);
    lower = std::max(left * lower, drop(stance, gait.adjusted[0].pose, reach));
  }
  return ground + reach.standing_height - lower;
}

}  // namespace gaitd::walking
