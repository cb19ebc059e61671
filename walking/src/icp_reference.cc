// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/icp_reference.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gaitd/sdk/loads.h"
#include "gaitd/sdk/views.h"
#include "gaitd/walking/external_wrench.h"
#include "gaitd/walking/support.h"

namespace gaitd::walking {

namespace {

constexpr double kLateTime = 0.1;  // s
// Heights of the CoM, by which the start of a first transfer moves at most: it stays in the feet.
constexpr double kFitLimit = 0.06796;
// 1/s, k of the header: over within a step, and slower than the ICP, which would follow no faster.
constexpr double kDecay = 4.0;
// Margins of the CMP, by which the start of a last transfer stays away from the edge of both feet.
constexpr double kRoom = 3.0;

// Both feet as the last step of `gait` leaves them: where its CMP may go from one to the other.
ConvexPolygon last_stance(const GaitdModel& model, const GaitdGaitState& gait, double margin) {
  const GaitdFootstep& step = gait.adjusted[0];
  const int side = other_side(step.side);
  GaitdFoothold stance = gait.footholds[side];
  stance.contact = GAITD_CONTACT_FULL;
  ConvexPolygon feet;
  add_foothold(stance, model.feet[side].toe_point, feet);
  add_foothold(bearing_of(model, step), model.feet[step.side].toe_point, feet);
  feet.make_hull();
  return feet.inset(margin);
}

}  // namespace

using sdk::view;

void IcpReference::update(double dt, const GaitdRobotState& robot, const GaitdGaitState& gait,
                          const CmpOffsets& offsets, GaitdIcpPlan& plan) {
  const bool first = state_.plan_revision == kNotStarted;
  const bool resumed = std::exchange(resumed_, false);
  const bool changed = first || resumed || state_.plan_revision != gait.plan_revision;
  auto icp = view(state_.icp);
  auto delta = view(state_.offset);
  auto start = view(state_.start_ecmp);
  const double omega = gait.omega;
  // The first reference is where the robot rests: the CoM, which is far less noisy than the ICP.
  const Eigen::Vector2d at_rest =
      view(robot.com).head<2>() + lean(view(robot.external_wrench),
                                       sdk::total_mass(model_, robot.loads), model_.gravity, omega);

  trajectory_.build(model_, gait, offsets);
  const bool from_standing = gait.phase == GAITD_PHASE_TRANSFER && gait.trailing_side == GAITD_BOTH;
  // The swing of the last step, and the transfer after it: a walk may end earlier than planned.
  const bool ends = gait.phase == GAITD_PHASE_SWING && gait.footstep_count == 1;
  const bool ended = gait.phase == GAITD_PHASE_TRANSFER && !from_standing &&
                     gait.footstep_count == 0 && state_.phase != GAITD_PHASE_STAND;
  if (from_standing) {
    // A transfer that has just begun, or one that another variant began, is fitted once.
    const bool begun = gait.phase != state_.phase || gait.time_in_phase < 0.5 * dt;
    if (begun || state_.start_ecmp_valid == 0) {
      trajectory_.fit_start(first ? at_rest : Eigen::Vector2d(icp),
                            kFitLimit * model_.nominal_com_height);
      start = trajectory_.start();
      state_.start_ecmp_valid = 1;
    } else {
      trajectory_.set_start(start);
    }
  } else if (ends) {
    if (changed || state_.phase != gait.phase) {
      trajectory_.fit_last_start(first ? at_rest : Eigen::Vector2d(icp), gait.time_remaining,
                                 last_stance(model_, gait, kRoom * offsets.margin));
      start = trajectory_.last_start();
      state_.start_ecmp_valid = 1;
    } else {
      trajectory_.set_last_start(start);
    }
  } else if (ended && state_.start_ecmp_valid != 0) {
    trajectory_.set_start(start);
  } else {
    state_.start_ecmp_valid = 0;
  }

  // A swing whose touchdown is late goes on for a moment, as the robot does; then, and at the end
  // of a transfer that waits for the robot, the reference waits too.
  const double late = gait.time_in_phase - gait.phase_duration;
  const double longest = gait.phase == GAITD_PHASE_SWING ? kLateTime : 0.0;
  const bool waiting = !trajectory_.empty() && late > longest;
  const double remaining = waiting ? -longest : -late;
  IcpTrajectory::Sample s;
  if (trajectory_.empty()) {
    s.icp = s.icp_end = s.ecmp = trajectory_.rest();
    s.icp_velocity.setZero();
  } else {
    s = trajectory_.evaluate(remaining);
    if (waiting) s.ecmp = s.icp;  // stands still until the phase ends
  }
  if (changed) {
    // state_.icp already holds the prediction for this tick.
    const Eigen::Vector2d before = delta;
    delta = (first ? at_rest : Eigen::Vector2d(icp)) - s.icp;
    if (resumed && !first) otherwise_ = delta - before;
  } else if (gait.phase != GAITD_PHASE_STAND) {
    // Who stands has no reason to shift the weight.
    delta *= std::max(0.0, 1.0 - kDecay * dt);
  }

  const bool swings = gait.phase == GAITD_PHASE_SWING;
  if (!swings || state_.phase != gait.phase) otherwise_.setZero();
  otherwise_ *= std::max(0.0, 1.0 - kDecay * dt);

  plan.size = sizeof(plan);
  view(plan.icp) = s.icp + delta;
  const double leaving = gait.phase == GAITD_PHASE_STAND ? 0.0 : kDecay;
  view(plan.ecmp) = s.ecmp + (1.0 + leaving / omega) * delta;
  view(plan.icp_velocity) = omega * (view(plan.icp) - view(plan.ecmp));
  view(plan.icp_end) = s.icp_end;
  const int landed = gait.phase == GAITD_PHASE_TRANSFER ? 2 : 1;  // piece that begins then
  const bool steps = gait.footstep_count > 0;
  view(plan.icp_touchdown) = steps ? trajectory_.icp_at_start(landed) : s.icp_end;
  view(plan.icp_touchdown) += std::exp(-kDecay * std::max(gait.time_remaining, 0.0)) * otherwise_;
  view(plan.icp_transferred) = steps ? trajectory_.icp_at_start(landed + 1) : s.icp_end;
  view(plan.offset) = delta;
  plan.kappa =
      robot.com[2] > 0.0 ? model_.nominal_com_height * omega * omega / model_.gravity : 1.0;
  plan.time_remaining = gait.time_remaining;
  for (int i = 0; i < GAITD_MAX_FOOTSTEPS; ++i) {
    plan.gamma[i] = i < gait.footstep_count ? trajectory_.gamma(i, gait.time_remaining) : 0.0;
  }

  state_.size = sizeof(state_);
  state_.phase = gait.phase;
  state_.plan_revision = gait.plan_revision;
  icp = view(plan.icp) + dt * view(plan.icp_velocity);
}

}  // namespace gaitd::walking
