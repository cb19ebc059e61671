// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gaitd/abi/types.h"

namespace gaitd::walking {

// Length of a leg from hip pitch to ankle pitch, by the bend of its knee. A bend counts from the
// zero of the joint where the leg is straight there, to 0.3 rad; otherwise from where it is
// longest.
class LegGeometry {
 public:
  LegGeometry() = default;
  LegGeometry(const GaitdModel& model, int side);

  // rad, positive when bent, of a knee joint at `position`.
  double bend(double position) const { return sign_ * (position - straight_); }
  // rad, of the joint where its bend is 0.
  double straight() const { return straight_; }
  // rad, by which an ankle joint at `position` bends the shank ahead over a sole that is square to
  // it at 0: of the zero of the joint, to 0.3 rad.
  double dorsiflexion(double position) const { return ankle_sign_ * (position - ankle_square_); }
  // m, for a knee bent by `knee` (rad, positive when bent).
  double length(double knee) const;
  // m/rad, by which it is shorter the more the knee bends there; that of a little bend where the
  // leg is straight or bent the wrong way.
  double shortening(double knee) const;
  // rad, the bent knee that makes the leg `length` metres long; the nearest there is.
  double knee(double length) const;
  // rad, by which the thigh of a leg of that length points ahead of the line from hip to ankle.
  double thigh(double length) const;

 private:
  double thigh_ = 0.4, shank_ = 0.4;  // m
  double sign_ = 1.0;
  double straight_ = 0.0;  // rad, of the joint
  double offset_ = 0.0;    // rad, bend of the line hip-knee-ankle at bend 0
  double ankle_sign_ = 1.0;
  double ankle_square_ = 0.0;  // rad, of the joint of the ankle
};

// rad: least bend of a leg that stands, for a step of `horizontal` metres without what the feet
// stand apart anyway. At touchdown the hip is `hip` (m) from the ankle that stands, along the step,
// and the landing leg has the knee `straight` (rad); the hip comes down by at most `largest_drop`
// (m) from mid-stance to there, besides what the ground goes down.
double straightest_knee(const LegGeometry& leg, double horizontal, double hip, double straight,
                        double largest_drop);

}  // namespace gaitd::walking
