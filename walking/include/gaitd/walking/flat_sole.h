// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "gaitd/abi/plugin.h"
#include "gaitd/walking/polygon.h"

namespace gaitd::walking {

// How a sole came to lie on the ground, and how far it has tilted from that since. It lies as it
// does after the first moments of load; after that, flat follows ground that gives way, but not a
// foot whose CoP is at an edge, where it may just be tipping.
class FlatSole {
 public:
  void reset() { time_loaded_ = 0.0; }
  // One tick of `dt` seconds. `foothold` has the polygon that bears; `weight` (N) of the robot.
  void update(double dt, const GaitdFootState& foot, const GaitdFoothold& foothold, double weight);

  bool settled() const { return settled_; }  // it has borne load for long enough to be flat
  bool loaded() const { return loaded_; }
  bool still() const { return still_; }
  bool inside() const { return inside_; }  // the CoP is measured, and not at an edge of the polygon
  const ConvexPolygon& sole() const { return sole_; }  // m, axes of the sole
  // rad, axes of the sole: from flat to where it is now, without the heading.
  Eigen::Vector2d tilt(const GaitdFootState& foot) const;
  Eigen::Vector2d rate(const GaitdFootState& foot) const;  // rad/s, likewise
  // From now on this is flat.
  void accept(const GaitdFootState& foot);

 private:
  Eigen::Quaterniond flat_ = Eigen::Quaterniond::Identity();  // sole in W
  ConvexPolygon sole_;
  double time_loaded_ = 0.0;  // s
  bool settled_ = false, loaded_ = false, still_ = false, inside_ = false;
};

}  // namespace gaitd::walking
