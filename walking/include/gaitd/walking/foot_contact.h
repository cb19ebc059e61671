// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "gaitd/abi/plugin.h"
#include "gaitd/walking/flat_sole.h"
#include "gaitd/walking/polygon.h"

namespace gaitd::walking {

// Finds out which part of a foothold carries. Where a part of the sole hangs over an edge, the foot
// tips about that edge as soon as its CoP gets there, and the CoP stays on it: what is beyond
// carries nothing. It is the walk itself that tries the foothold out. After Wiedebach et al.,
// "Walking on Partial Footholds Including Line Contacts with the Humanoid Robot Atlas", Humanoids
// 2016, section III.
class FootContact {
 public:
  // The foot has come down `off` heights of the CoM above or below where it was told to.
  void land(double off);
  // Nothing more is found out of this foothold; what was found out stays.
  void doubt();
  // The foot is in the air or rolls on purpose: what was found out is over.
  void reset();
  // One tick of `dt` seconds of a foot that should lie flat on `foothold`, whose polygon becomes
  // what is known to carry of the one of `told`; whether that changed. `weight` (N) of the robot.
  bool update(double dt, const GaitdFootState& foot, double weight, const GaitdFoothold& told,
              GaitdFoothold& foothold);

  // m^2 over m^2, of what the foothold was told to carry: 1 as long as nothing was found out.
  double share() const { return share_; }

 private:
  // Part of `sole`, of a foothold of `width` (m), that a foot that is tipping by `tilt` bears on.
  ConvexPolygon bearing(const ConvexPolygon& sole, double width, const Eigen::Vector2d& tilt) const;

  FlatSole lie_;
  double share_ = 1.0;
  Eigen::Vector2d cop_ = Eigen::Vector2d::Zero();  // m, axes of the sole, filtered
  bool high_as_told_ = true;                       // it came down at the height that it was told,
  bool flat_as_told_ = false;                      // and to lie as it was told
  double time_pressed_ = 0.0;                      // s, for which it has been measured
  double time_beyond_ = 0.0;                       // s, of a CoP where nothing should carry
};

}  // namespace gaitd::walking
