// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/com_height.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"

namespace gaitd::walking {
namespace {

// How far the CoM must come down so that a leg can span two footholds.
double drop(const GaitdPose& a, const GaitdPose& b, const LegReach& r) {
  const Eigen::Vector3d d =
      sdk::quaternion(a.orientation).conjugate() * (sdk::view(b.position) - sdk::view(a.position));
  const double sideways = std::max(0.0, std::abs(d.y()) - r.nominal_separation);
  const double horizontal = r.trailing_share * std::hypot(d.x(), sideways);
  const double vertical = std::sqrt(std::max(0.0, r.longest * r.longest - horizontal * horizontal));
  return std::clamp(r.leg_length - vertical, 0.0, r.largest_drop);
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
  } else if (gait.phase == GAITD_PHASE_TRANSFER && gait.trailing_side != GAITD_BOTH) {
    const double start = gait.footholds[gait.trailing_side].pose.position[2];
    ground = start + share * (ground - start);
  } else if (gait.phase == GAITD_PHASE_SWING) {
    const GaitdPose& stance = gait.footholds[gait.support].pose;
    ground = stance.position[2];
    // Low enough for the step that is coming, never waiting for it.
    lower = std::max((1.0 - share) * lower, drop(stance, gait.adjusted[0].pose, reach));
  }
  return ground + reach.standing_height - lower;
}

}  // namespace gaitd::walking
