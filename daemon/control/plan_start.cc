// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/plan_start.h"

#include <cmath>

#include "gaitd/walking/support.h"

namespace gaitd::daemon {
namespace {

constexpr double kInPlace = 0.02;  // m, by which a foot that stands may have been moved

}  // namespace

bool is_chosen_only(const walking::GaitMachine& gait) {
  const GaitdGaitState& state = gait.state();
  return state.phase == GAITD_PHASE_TRANSFER && state.transfer_final == 0 &&
         state.footstep_count > 0;
}

footsteps::Start standing_start(const walking::GaitMachine& gait) {
  const GaitdGaitState& state = gait.state();
  footsteps::Start start;
  start.omega = state.omega;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    start.feet[side] = state.footholds[side].pose;
    start.feet[side].position[2] -= gait.height_offset();
  }
  return start;
}

footsteps::Start plan_start(const walking::GaitMachine& gait) {
  const GaitdGaitState& state = gait.state();
  footsteps::Start start = standing_start(gait);
  const bool swings = state.phase == GAITD_PHASE_SWING && state.footstep_count > 0;
  if (!swings && !is_chosen_only(gait)) return start;
  const GaitdFootstep& step = state.commanded[0];
  start.under_way = step;
  start.feet[step.side] = step.pose;
  start.first_side = walking::other_side(step.side);
  return start;
}

bool still_fits(const footsteps::Start& planned, const footsteps::Start& now) {
  if (planned.first_side != now.first_side) return false;
  if (planned.under_way.has_value() != now.under_way.has_value()) return false;
  if (planned.under_way && planned.under_way->id != now.under_way->id) return false;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const double* a = planned.feet[side].position;
    const double* b = now.feet[side].position;
    if (std::hypot(a[0] - b[0], a[1] - b[1]) > kInPlace) return false;
  }
  return true;
}

}  // namespace gaitd::daemon
