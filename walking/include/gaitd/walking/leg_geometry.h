// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gaitd/abi/types.h"

namespace gaitd::walking {

// Length of a leg from hip pitch to ankle pitch, by its knee.
class LegGeometry {
 public:
  LegGeometry() = default;
  LegGeometry(const GaitdModel& model, int side);

  // m, for a knee bent by `knee` (rad, positive when bent).
  double length(double knee) const;
  // rad, the bent knee that makes the leg `length` metres long; the nearest there is.
  double knee(double length) const;
  // rad, by which the thigh of a leg of that length points ahead of the line from hip to ankle.
  double thigh(double length) const;

 private:
  double thigh_ = 0.4, shank_ = 0.4;  // m
  double offset_ = 0.0;               // rad, bend of the line hip-knee-ankle at knee 0
};

// What the coming step asks of the leg that stands (theory section 4: as straight as it can be).
struct StepReach {
  double straight_knee;   // rad, least bend in mid-stance
  double collapsed_knee;  // rad, bend at touchdown
};

// `horizontal` (m) is the step from the standing foot to the coming foothold, without what the feet
// stand apart anyway; `drop` (m) by how much it is lower. At touchdown the hip is `hip` (m) from
// the ankle that stands, along the step, and the landing leg has the knee `straight` (rad); the hip
// comes down by at most `largest_drop` (m) from mid-stance to there, plus the drop itself.
StepReach step_reach(const LegGeometry& leg, double horizontal, double drop, double hip,
                     double straight, double largest_drop);

}  // namespace gaitd::walking
