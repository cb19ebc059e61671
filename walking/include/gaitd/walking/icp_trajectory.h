// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "gaitd/abi/types.h"
#include "gaitd/walking/polygon.h"

namespace gaitd::walking {

// Where the eCMP enters and leaves a foothold, as fractions of half the length (x, towards the
// toe) and half the width (y, towards the other foot) of its loadable part, from its middle.
struct CmpOffsets {
  // Of a robot whose CoM is at `height` (m) in the nominal posture.
  explicit CmpOffsets(double height)
      : exit_x_step_length(0.1699 * height), margin(0.01274 * height) {}
  double entry_x = -0.08;
  double entry_y = -0.08;
  double exit_x = 0.73;
  double exit_y = 0.31;
  // Forward distance of the next foothold at which the full exit_x is used (m); shorter and
  // backward steps leave the foot proportionally further back.
  double exit_x_step_length;
  double margin;  // m, kept from the edge
};

// Piecewise linear eCMP reference with the ICP that belongs to it (Englsberger 2014; theory
// section 2). On a piece r(t) = r0 + c t, so that everything is closed-form:
//   backwards: xi(t) = r(t) + c/w + exp(-w (T - t)) (xi_T - r1 - c/w)
// The last piece ends at rest: xi = r1.
class IcpTrajectory {
 public:
  static constexpr int kMaxPieces = 2 * GAITD_MAX_FOOTSTEPS + 2;

  struct Sample {
    Eigen::Vector2d icp;           // m
    Eigen::Vector2d icp_velocity;  // m/s
    Eigen::Vector2d ecmp;          // m
    Eigen::Vector2d icp_end;       // m, at the end of the current piece
  };

  // Builds the pieces from the current phase of `gait` to standing over all footsteps ahead.
  void build(const GaitdModel& model, const GaitdGaitState& gait, const CmpOffsets& offsets);

  bool empty() const { return count_ == 0; }
  int piece_count() const { return count_; }
  // Reference with `remaining` seconds left in the current piece; below zero it goes on around the
  // last eCMP of the piece, as the robot does. Not for an empty trajectory.
  Sample evaluate(double remaining) const;
  // ICP at the start of piece `first`, seen as the end of the piece before (m).
  Eigen::Vector2d icp_at_start(int first) const;
  // d icp / d (footstep i and all after it), with `remaining` seconds left in the current piece.
  double gamma(int footstep, double remaining) const;

  // Where a CoM that is now at `com` (m) is at the ends of the first pieces, when it follows the
  // ICP: as many as fit, standing at the last end beyond that.
  void com_at_ends(Eigen::Vector2d com, std::span<Eigen::Vector2d> ends) const;

  // First transfer: the start of the first piece is free so that the ICP begins at `icp` (m) with
  // the whole piece ahead; kept within `limit` metres of where it was. Theory section 2.
  void fit_start(const Eigen::Vector2d& icp, double limit);
  void set_start(const Eigen::Vector2d& ecmp) { pieces_[0].start = ecmp; }
  const Eigen::Vector2d& start() const { return pieces_[0].start; }
  // Last transfer, seen from the swing before it: its start is free so that the ICP is at `icp` (m)
  // with `remaining` seconds of that swing left; kept inside `region`. Nothing without both pieces.
  void fit_last_start(const Eigen::Vector2d& icp, double remaining, const ConvexPolygon& region);
  void set_last_start(const Eigen::Vector2d& ecmp) { pieces_[count_ - 1].start = ecmp; }
  const Eigen::Vector2d& last_start() const { return pieces_[count_ - 1].start; }
  // Where the ICP rests when there is no piece: the middle of the feet (m).
  const Eigen::Vector2d& rest() const { return rest_; }

 private:
  struct Piece {
    Eigen::Vector2d start, end;
    double duration;
    // How far start and end move when footstep i moves along with all later ones: 0, 1/2 or 1,
    // by the index of the (newer) footstep they belong to; -1 for feet on the ground.
    int start_step, end_step;
    double end_share;  // share of the end that belongs to end_step; the rest to the step before
  };
  // Where `p` starts if the ICP goes from `icp` to `icp_end` over it (m).
  Eigen::Vector2d fitted_start(const Piece& p, const Eigen::Vector2d& icp,
                               const Eigen::Vector2d& icp_end) const;
  void add(const Eigen::Vector2d& start, int start_step, const Eigen::Vector2d& end, int end_step,
           double duration, double end_share = 1.0);
  std::array<Piece, kMaxPieces> pieces_;
  int count_ = 0;
  double omega_ = 3.0;
  Eigen::Vector2d rest_ = Eigen::Vector2d::Zero();
};

// Entry and exit points of one foothold in W (m). `next` is the foothold that follows, for the
// exit; null when none does.
Eigen::Vector2d entry_cmp(const GaitdFoothold& foothold, int side, const CmpOffsets& offsets);
Eigen::Vector2d exit_cmp(const GaitdFoothold& foothold, int side, const GaitdFoothold* next,
                         const CmpOffsets& offsets);

}  // namespace gaitd::walking
