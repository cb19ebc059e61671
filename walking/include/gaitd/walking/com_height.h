// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gaitd/abi/types.h"

namespace gaitd::walking {

// Second-order reference filter, critically damped: turns steps of a target into a reference with
// continuous velocity and known acceleration.
class ReferenceFilter {
 public:
  void reset(double value) {
    value_ = value;
    velocity_ = acceleration_ = 0.0;
  }
  // `rate` in 1/s.
  void update(double dt, double target, double rate) {
    acceleration_ = rate * rate * (target - value_) - 2.0 * rate * velocity_;
    velocity_ += acceleration_ * dt;
    value_ += velocity_ * dt;
  }
  double value() const { return value_; }
  double velocity() const { return velocity_; }
  double acceleration() const { return acceleration_; }

 private:
  double value_ = 0.0, velocity_ = 0.0, acceleration_ = 0.0;
};

// Height (m, W) that the CoM aims at: `standing_height` above the ground under the feet, lowered by
// what a leg of `leg_length` (hip to ankle, m) needs to span the feet: l - sqrt(l^2 - (d/2)^2), d
// the horizontal distance of the footholds. Blends from one foothold to the next over the phase.
double com_height_target(const GaitdGaitState& gait, double standing_height, double leg_length,
                         double nominal_separation);

}  // namespace gaitd::walking
