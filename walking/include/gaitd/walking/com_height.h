// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>

#include "gaitd/abi/types.h"

namespace gaitd::walking {

// Second-order reference filter, critically damped: turns steps of a target into a reference with
// continuous velocity and known acceleration.
class ReferenceFilter {
 public:
  void reset(double value, double velocity = 0.0) {
    value_ = value;
    velocity_ = velocity;
    acceleration_ = 0.0;
  }
  // `rate` in 1/s; `fastest` bounds the velocity.
  void update(double dt, double target, double rate,
              double fastest = std::numeric_limits<double>::infinity()) {
    const double before = velocity_;
    acceleration_ = rate * rate * (target - value_) - 2.0 * rate * velocity_;
    velocity_ = std::clamp(velocity_ + acceleration_ * dt, -fastest, fastest);
    acceleration_ = (velocity_ - before) / dt;
    value_ += velocity_ * dt;
  }
  double value() const { return value_; }
  double velocity() const { return velocity_; }
  double acceleration() const { return acceleration_; }

 private:
  double value_ = 0.0, velocity_ = 0.0, acceleration_ = 0.0;
};

// What the legs allow: lengths from the robot, shares from parameters.
struct LegReach {
  double standing_height;     // m, CoM above the ground when the feet are side by side
  double leg_length;          // m, hip to ankle in that posture
  double longest;             // m, hip to ankle that a leg may be stretched to
  double trailing_share;      // of the step by which the hip is ahead of the trailing ankle
  double nominal_separation;  // m, of the feet sideways
  double largest_drop;        // m
};

// Height (m, W) that the CoM aims at, with both soles flat until lift-off: as high as when
// standing, lowered by what the trailing leg needs to reach its foothold at the end of a transfer,
// and the landing leg a lower one at the end of a swing. Blends from one foothold to the next over
// the phase.
double com_height_target(const GaitdGaitState& gait, const LegReach& reach);

}  // namespace gaitd::walking
