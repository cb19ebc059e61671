// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "gaitd/abi/types.h"
#include "gaitd/walking/leg_geometry.h"
#include "gaitd/walking/refusal.h"

namespace gaitd::walking {

// What hip and knee can do in a swing, by the velocity limits of the model and the lengths of its
// legs: hip pitch and knee go from lift-off over the apex to touchdown, with the hip half-way
// between the feet and as high as in the nominal posture, or as low as the longer leg makes it.
class SwingLimits {
 public:
  explicit SwingLimits(const GaitdModel& model);

  // Whether the foot that stands at `from` gets to `step` in the duration and over the height that
  // the footstep says (both positive), beside the other foot at `stance`. `number` names the
  // footstep in the message, from 1.
  Refusal check(const GaitdFootstep& step, const GaitdPose& stance, const GaitdPose& from,
                int number) const;

 private:
  struct Angles {
    double hip, knee;  // rad
  };
  struct Leg {
    LegGeometry geometry;
    double shortest, longest;         // m, at the position limits of the knee
    double standing;                  // m, of hip pitch above ankle pitch in the nominal posture
    double hip_speed, knee_speed;     // rad/s
    std::string hip_name, knee_name;  // in the model
  };

  // Of a leg whose ankle is `ahead` of the hip and `below` it (m).
  static Angles angles(const Leg& leg, double ahead, double below);

  std::array<Leg, GAITD_MAX_FEET> legs_;
  double separation_;  // m, of the feet in the nominal posture
};

}  // namespace gaitd::walking
