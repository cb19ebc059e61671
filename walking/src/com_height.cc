// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/com_height.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"

namespace gaitd::walking {
namespace {

double drop(double distance, double leg_length) {
  const double half = std::min(0.5 * distance, 0.9 * leg_length);
  return leg_length - std::sqrt(leg_length * leg_length - half * half);
}

double span(const GaitdPose& a, const GaitdPose& b) {
  return std::hypot(a.position[0] - b.position[0], a.position[1] - b.position[1]);
}

}  // namespace

double com_height_target(const GaitdGaitState& gait, double standing_height, double leg_length,
                         double nominal_separation) {
  const GaitdPose& left = gait.footholds[GAITD_LEFT].pose;
  const GaitdPose& right = gait.footholds[GAITD_RIGHT].pose;
  double ground = 0.5 * (left.position[2] + right.position[2]);
  double distance = span(left, right);
  const double share =
      gait.phase_duration > 0.0 ? std::clamp(gait.time_in_phase / gait.phase_duration, 0.0, 1.0)
                                : 1.0;
  if (gait.phase == GAITD_PHASE_TRANSFER && gait.transfer_final == 0 && gait.footstep_count > 0) {
    const int trailing = gait.next_side;
    const double from = gait.footholds[trailing].pose.position[2];
    const double to = gait.footholds[other_side(trailing)].pose.position[2];
    const double start = gait.trailing_side == GAITD_BOTH ? ground : from;
    ground = start + share * (to - start);
    if (gait.trailing_side == GAITD_BOTH) {
      distance = std::max(distance, share * span(gait.footholds[other_side(trailing)].pose,
                                                 gait.adjusted[0].pose));
    }
  } else if (gait.phase == GAITD_PHASE_SWING) {
    const GaitdPose& stance = gait.footholds[gait.support].pose;
    ground = stance.position[2];
    // Low enough for the step that is coming, never waiting for it.
    distance = std::max(distance * (1.0 - share), span(stance, gait.adjusted[0].pose));
  }
  return ground + standing_height -
         std::max(0.0, drop(distance, leg_length) - drop(nominal_separation, leg_length));
}

}  // namespace gaitd::walking
