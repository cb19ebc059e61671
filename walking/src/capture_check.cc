// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/capture_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/icp_trajectory.h"
#include "gaitd/walking/polygon.h"
#include "gaitd/walking/support.h"

namespace gaitd::walking {
namespace {

// Over 1 / omega, the time in which an ICP runs away: by how much a foot may land early or late,
// for ground that is not where it was said to be.
constexpr double kLandingError = 0.2;
// s, between the transfers that are tried for the advice, and the last of them.
constexpr double kTransferStep = 0.05;
constexpr double kLongestTransfer = 1.0;

// m, from `p` along the unit vector `u` to the border; 0 for a point beside the polygon.
double room_along(const ConvexPolygon& polygon, const Eigen::Vector2d& p,
                  const Eigen::Vector2d& u) {
  double least = polygon.size() < 3 ? 0.0 : INFINITY;
  for (int i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon.vertex(i);
    const Eigen::Vector2d d = polygon.vertex((i + 1) % polygon.size()) - a;
    const Eigen::Vector2d outwards(d.y(), -d.x());
    const double speed = outwards.dot(u);
    const double inside = outwards.dot(a - p);
    if (speed > 1e-12) least = std::min(least, std::max(0.0, inside / speed));
  }
  return least;
}

}  // namespace

CaptureCheck::Room CaptureCheck::room(const GaitdFoothold& stance, const GaitdFootstep* steps,
                                      int count, double final_transfer, double omega) const {
  const int side = steps[0].side;
  GaitdGaitState gait{};
  gait.phase = GAITD_PHASE_SWING;
  gait.support = other_side(side);
  gait.next_side = side;
  gait.trailing_side = GAITD_BOTH;
  gait.omega = omega;
  gait.phase_duration = steps[0].swing_duration;
  gait.final_transfer_duration = final_transfer;
  gait.footholds[gait.support] = stance;
  gait.footstep_count = std::min(count, kAhead);
  for (int i = 0; i < gait.footstep_count; ++i) gait.adjusted[i] = steps[i];
  const CmpOffsets offsets(model_.nominal_com_height);
  IcpTrajectory plan;
  plan.build(model_, gait, offsets);
  const IcpTrajectory::Sample end = plan.evaluate(0.0);
  const Eigen::Vector2d away = end.icp_end - end.ecmp;
  const double distance = away.norm();
  if (!(distance > 0.0)) return {0.0, INFINITY};

  const GaitdFoothold landed = bearing_of(model_, steps[0]);
  const Eigen::Vector2d entry = entry_cmp(landed, side, offsets);
  ConvexPolygon alone, both;
  for (ConvexPolygon* polygon : {&alone, &both}) {
    add_foothold(landed, model_.feet[side].toe_point, *polygon);
  }
  add_foothold(stance, model_.feet[gait.support].toe_point, both);
  alone.make_hull();
  both.make_hull();

  const double transfer = std::exp(-omega * steps[1].transfer_duration);
  const double swing = std::exp(-omega * steps[1].swing_duration);
  Room worst{0.0, INFINITY};
  for (const double sign : {1.0, -1.0}) {
    const double error = distance * std::abs(std::exp(sign * kLandingError) - 1.0);
    const Eigen::Vector2d u = sign / distance * away;
    const double capture = room_along(both, 0.5 * (end.ecmp + entry), u) * (1.0 - transfer) +
                           room_along(alone, entry, u) * (1.0 - swing) * transfer;
    if (capture - error < worst.capture - worst.error) worst = {error, capture};
  }
  return worst;
}

Refusal CaptureCheck::check(const GaitdFoothold& stance, const GaitdFootstep* steps, int count,
                            double final_transfer, double omega, int number) const {
  const Room r = room(stance, steps, count, final_transfer, omega);
  if (r.capture >= r.error) return {};
  std::array<GaitdFootstep, kAhead> slower;
  count = std::min(count, kAhead);
  std::copy(steps, steps + count, slower.begin());
  double& transfer = slower[1].transfer_duration;
  char advice[64] = "take shorter steps";
  while (transfer < kLongestTransfer) {
    transfer += kTransferStep;
    const Room more = room(stance, slower.data(), count, final_transfer, omega);
    if (more.capture < more.error) continue;
    std::snprintf(advice, sizeof(advice), "let the transfer take %.2f s", transfer);
    break;
  }
  return refuse(
      "footstep %d (%s): when the foot before it lands %.2f s early or late, the capture point is "
      "off by %.3f m, and a transfer of %.2f s and a swing of %.2f s bring back %.3f; %s",
      number, side_name(steps[1].side), kLandingError / omega, r.error, steps[1].transfer_duration,
      steps[1].swing_duration, r.capture, advice);
}

}  // namespace gaitd::walking
