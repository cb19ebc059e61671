// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gaitd/abi/types.h"
#include "gaitd/walking/footsteps.h"
#include "gaitd/walking/refusal.h"
#include "gaitd/walking/swing_limits.h"
#include "gaitd/walking/turn_reach.h"

namespace gaitd::walking {

// Whether a footstep can be taken, as far as it can be judged without what comes before and after:
// one order of checks for the gait machine and for whoever plans for it.
class StepCheck {
 public:
  explicit StepCheck(const GaitdModel& model);

  // `step`, with all durations and its swing height, from `stance`, the pose of the other foot, by
  // the foot that stands at `from` before. `number` names it in the message, from 1.
  Refusal check(const GaitdFootstep& step, const GaitdPose& stance, const GaitdPose& from,
                int number, const GaitParameters& parameters) const;

 private:
  const GaitdModel model_;
  TurnReach turn_reach_;
  SwingLimits swing_limits_;
};

}  // namespace gaitd::walking
