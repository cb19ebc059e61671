// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/icp_trajectory.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"

namespace gaitd::walking {
namespace {

// Shorter pieces are treated as this long: the slope of the eCMP must stay finite.
constexpr double kShortestPiece = 1e-3;

// A foothold need not be a rectangle: the fractions are of its extent, and the point stays inside.
Eigen::Vector2d point_in_sole(const GaitdFoothold& foothold, int side, double x_fraction,
                              double inwards_fraction, double margin) {
  const SoleExtent e = sole_extent(foothold);
  const auto at = [](double low, double high, double fraction) {
    return 0.5 * (high + low) + fraction * 0.5 * (high - low);
  };
  Eigen::Vector2d point(at(e.x_min, e.x_max, x_fraction),
                        at(e.y_min, e.y_max, -side_sign(side) * inwards_fraction));
  const ConvexPolygon polygon = polygon_of(foothold);
  if (polygon.inside_distance(point) < margin) point = polygon.inset(margin).closest_point(point);
  return sdk::transform(foothold.pose, {point.x(), point.y(), 0.0}).head<2>();
}

}  // namespace

Eigen::Vector2d entry_cmp(const GaitdFoothold& foothold, int side, const CmpOffsets& o) {
  return point_in_sole(foothold, side, o.entry_x, o.entry_y, o.margin);
}

Eigen::Vector2d exit_cmp(const GaitdFoothold& foothold, int side, const GaitdFoothold* next,
                         const CmpOffsets& o) {
  double forward = 0.0;
  if (next != nullptr) {
    const Eigen::Vector3d step = sdk::view(next->pose.position) - sdk::view(foothold.pose.position);
    forward = (sdk::quaternion(foothold.pose.orientation).conjugate() * step).x();
  }
  const double share =
      o.exit_x_step_length > 0.0 ? std::clamp(forward / o.exit_x_step_length, -0.5, 1.0) : 1.0;
  return point_in_sole(foothold, side, share * o.exit_x, o.exit_y, o.margin);
}

void IcpTrajectory::add(const Eigen::Vector2d& start, int start_step, const Eigen::Vector2d& end,
                        int end_step, double duration, double end_share) {
  if (count_ == kMaxPieces) return;
  pieces_[count_++] = {start,      end,      std::max(duration, kShortestPiece),
                       start_step, end_step, end_share};
}

void IcpTrajectory::build(const GaitdModel& model, const GaitdGaitState& gait,
                          const CmpOffsets& o) {
  count_ = 0;
  omega_ = gait.omega;
  const GaitdFoothold& left = gait.footholds[GAITD_LEFT];
  const GaitdFoothold& right = gait.footholds[GAITD_RIGHT];
  rest_ = middle(left, right);
  if (gait.phase == GAITD_PHASE_STAND) return;

  if (gait.phase == GAITD_PHASE_TRANSFER && (gait.transfer_final || gait.footstep_count == 0)) {
    Eigen::Vector2d from = rest_;
    if (gait.trailing_side != GAITD_BOTH) {
      const int t = gait.trailing_side;
      from = exit_cmp(gait.footholds[t], t, &gait.footholds[other_side(t)], o);
    }
    add(from, -1, rest_, -1, gait.phase_duration);
    return;
  }

  int side = other_side(gait.adjusted[0].side);  // the stance foot of the first swing
  GaitdFoothold stance = gait.footholds[side];
  stance.contact = GAITD_CONTACT_FULL;
  int stance_step = -1;
  if (gait.phase == GAITD_PHASE_TRANSFER) {
    Eigen::Vector2d from = rest_;
    if (gait.trailing_side != GAITD_BOTH) {
      const int t = gait.trailing_side;
      from = exit_cmp(gait.footholds[t], t, &gait.footholds[other_side(t)], o);
    }
    add(from, -1, entry_cmp(stance, side, o), -1, gait.phase_duration);
  }
  for (int i = 0; i < gait.footstep_count; ++i) {
    const GaitdFootstep& step = gait.adjusted[i];
    const GaitdFoothold landing = bearing_of(model, step);
    const Eigen::Vector2d entry = entry_cmp(stance, side, o);
    const Eigen::Vector2d exit = exit_cmp(stance, side, &landing, o);
    const bool current = i == 0 && gait.phase == GAITD_PHASE_SWING;
    add(entry, stance_step, exit, stance_step, current ? gait.phase_duration : step.swing_duration);
    if (i + 1 < gait.footstep_count) {
      add(exit, stance_step, entry_cmp(landing, step.side, o), i,
          gait.adjusted[i + 1].transfer_duration);
    } else {
      add(exit, stance_step, middle(stance, landing), i, gait.final_transfer_duration, 0.5);
    }
    stance = landing;
    stance_step = i;
    side = step.side;
  }
}

Eigen::Vector2d IcpTrajectory::icp_at_start(int first) const {
  Eigen::Vector2d icp = count_ > 0 ? pieces_[count_ - 1].end : rest_;
  for (int i = count_ - 1; i >= first; --i) {
    const Piece& p = pieces_[i];
    const Eigen::Vector2d slope = (p.end - p.start) / (p.duration * omega_);
    icp = p.start + slope + std::exp(-omega_ * p.duration) * (icp - p.end - slope);
  }
  return icp;
}

IcpTrajectory::Sample IcpTrajectory::evaluate(double remaining) const {
  const Piece& p = pieces_[0];
  Sample s;
  s.icp_end = icp_at_start(1);
  if (remaining < 0.0) {
    s.ecmp = p.end;
    s.icp = p.end + std::exp(-omega_ * remaining) * (s.icp_end - p.end);
    s.icp_velocity = omega_ * (s.icp - s.ecmp);
    return s;
  }
  const double left = std::min(remaining, p.duration);
  const Eigen::Vector2d slope = (p.end - p.start) / (p.duration * omega_);
  s.ecmp = p.end - slope * omega_ * left;
  s.icp = s.ecmp + slope + std::exp(-omega_ * left) * (s.icp_end - p.end - slope);
  s.icp_velocity = omega_ * (s.icp - s.ecmp);
  return s;
}

double IcpTrajectory::gamma(int footstep, double remaining) const {
  if (count_ == 0) return 0.0;
  auto moved = [footstep](int step) { return step >= footstep ? 1.0 : 0.0; };
  auto end_of = [&](const Piece& p) {
    return p.end_share * moved(p.end_step) + (1.0 - p.end_share) * moved(p.end_step - 1);
  };
  double icp = end_of(pieces_[count_ - 1]);
  for (int i = count_ - 1; i >= 1; --i) {
    const Piece& p = pieces_[i];
    const double start = moved(p.start_step);
    const double end = end_of(p);
    const double slope = (end - start) / (p.duration * omega_);
    icp = start + slope + std::exp(-omega_ * p.duration) * (icp - end - slope);
  }
  const Piece& p = pieces_[0];
  const double left = std::clamp(remaining, 0.0, p.duration);
  const double end = end_of(p);
  const double slope = (end - moved(p.start_step)) / (p.duration * omega_);
  return end - slope * omega_ * left + slope + std::exp(-omega_ * left) * (icp - end - slope);
}

// On a piece xi = r + c/w + B exp(w t), so that com' = w (xi - com) has the solution
// com = r + B/2 exp(w t) + K exp(-w t).
void IcpTrajectory::com_at_ends(Eigen::Vector2d com, std::span<Eigen::Vector2d> ends) const {
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (static_cast<int>(i) < count_) {
      const Piece& p = pieces_[i];
      const double decay = std::exp(-omega_ * p.duration);
      const Eigen::Vector2d slope = (p.end - p.start) / (p.duration * omega_);
      const Eigen::Vector2d end = icp_at_start(static_cast<int>(i) + 1) - p.end - slope;
      com = p.end + 0.5 * end + decay * (com - p.start - 0.5 * decay * end);
    }
    ends[i] = com;
  }
}

Eigen::Vector2d IcpTrajectory::fitted_start(const Piece& p, const Eigen::Vector2d& icp,
                                            const Eigen::Vector2d& icp_end) const {
  const double e = std::exp(-omega_ * p.duration);
  const double w = 1.0 / (omega_ * p.duration);
  return (icp - p.end * (w - e * (1.0 + w)) - e * icp_end) / (1.0 - w + e * w);
}

void IcpTrajectory::fit_last_start(const Eigen::Vector2d& icp, double remaining,
                                   const ConvexPolygon& region) {
  if (count_ != 2) return;
  const Piece& swing = pieces_[0];
  Piece& last = pieces_[1];
  const double left = std::clamp(remaining, 0.0, swing.duration);
  const Eigen::Vector2d slope = (swing.end - swing.start) / (swing.duration * omega_);
  const Eigen::Vector2d ecmp = swing.end - slope * omega_ * left;
  const Eigen::Vector2d icp_end =
      swing.end + slope + std::exp(omega_ * left) * (icp - ecmp - slope);
  last.start = region.closest_point(fitted_start(last, icp_end, last.end));
}

void IcpTrajectory::fit_start(const Eigen::Vector2d& icp, double limit) {
  if (count_ == 0) return;
  Piece& p = pieces_[0];
  const Eigen::Vector2d fitted = fitted_start(p, icp, icp_at_start(1));
  const Eigen::Vector2d shift = fitted - p.start;
  const double length = shift.norm();
  p.start += length > limit ? Eigen::Vector2d(shift * (limit / length)) : shift;
}

}  // namespace gaitd::walking
