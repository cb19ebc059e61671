// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "gaitd/abi/types.h"
#include "gaitd/walking/refusal.h"

namespace gaitd::walking {

// How far the legs turn the feet against each other, by the position limits of their joints: flat
// soles below a level pelvis. The inverse kinematics are solved once, in the nominal posture; for a
// leg whose first joint is its yaw the result holds wherever the foot is.
class TurnReach {
 public:
  explicit TurnReach(const GaitdModel& model);

  // Of a sole against the pelvis, and the joint that is then at its stop.
  struct End {
    double yaw = 0.0;   // rad, positive to the left
    std::string joint;  // in the model
  };
  const End& right_end(int side) const { return legs_[side][0]; }
  const End& left_end(int side) const { return legs_[side][1]; }

  // Whether the foot can be turned as `step` says, beside the other foot at `stance`. `number`
  // names the footstep in the message, from 1.
  Refusal check(const GaitdFootstep& step, const GaitdPose& stance, int number) const;

 private:
  std::array<std::array<End, 2>, GAITD_MAX_FEET> legs_;  // to the right, to the left
};

}  // namespace gaitd::walking
