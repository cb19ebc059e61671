// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "gaitd/abi/plugin.h"
#include "gaitd/walking/flat_sole.h"

namespace gaitd::walking {

// How the sole of a loaded foot rests on the ground: flat, as it settled, or tilted about a line
// through its centre of pressure, when the CoP has come to an edge of the foot or of the ground
// under it. A tilted sole can press on that line only, whatever its polygon is. Told to press just
// beside it, where the sole has to come down, it turns back.
class SoleRest {
 public:
  struct Limits {
    double start;  // rad, of tilt from which the sole is not quite flat
    double full;   // rad, from which it is on its line
  };

  // In the air, or rolling on purpose.
  void reset();
  // One tick of `dt` seconds of a foot that should be flat. `foothold` has the polygon that bears;
  // `weight` (N) of the robot.
  void update(double dt, const GaitdFootState& foot, const GaitdFoothold& foothold, double weight,
              const Limits& limits);

  // 0: flat, 1: on its line.
  double share() const { return share_; }
  // rad, W: turns the sole back to where it was flat; without the heading.
  const Eigen::Vector3d& way_back() const { return way_back_; }
  // m, axes of the sole: the point about which it tilts; the origin when flat.
  const Eigen::Vector2d& pivot() const { return pivot_; }
  // m, axes of the sole: where a contact point of the flat sole is taken to bear now.
  Eigen::Vector2d bearing_point(const Eigen::Vector2d& p) const;

 private:
  FlatSole lie_;
  double share_ = 0.0;
  Eigen::Vector3d way_back_ = Eigen::Vector3d::Zero();
  Eigen::Vector2d pivot_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d bearing_ = Eigen::Vector2d::Zero();  // m, axes of the sole: a point of the line
  Eigen::Vector2d line_ = Eigen::Vector2d::UnitX();    // its direction
};

}  // namespace gaitd::walking
