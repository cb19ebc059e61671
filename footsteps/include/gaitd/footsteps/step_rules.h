// SPDX-License-Identifier: Apache-2.0
// Which footsteps the gait machine accepts, outside of it.
#ifndef GAITD_FOOTSTEPS_STEP_RULES_H_
#define GAITD_FOOTSTEPS_STEP_RULES_H_

#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/footsteps/planner.h"
#include "gaitd/walking/capture_check.h"
#include "gaitd/walking/footsteps.h"
#include "gaitd/walking/refusal.h"
#include "gaitd/walking/step_check.h"

namespace gaitd::footsteps {

// The checks of a command, as GaitMachine makes them.
class StepRules {
 public:
  explicit StepRules(const GaitdModel& model);

  // Whether `step`, with all durations and its swing height, can be taken beside the foot at
  // `stance` by the one that stands at `from`. `number` names it in the message, from 1.
  walking::Refusal check(const GaitdFootstep& step, const GaitdPose& stance, const GaitdPose& from,
                         int number, const walking::GaitParameters& parameters) const;

  // Whether `footsteps` can be taken one after the other. Transfers are made longer where the
  // weight would not get over in time.
  walking::Refusal finish(const Start& start, const walking::GaitParameters& parameters,
                          std::vector<GaitdFootstep>* footsteps) const;

 private:
  bool give_time(const Start& start, std::size_t landing,
                 std::vector<GaitdFootstep>* footsteps) const;

  const GaitdModel model_;
  walking::StepCheck step_check_;
  walking::CaptureCheck capture_check_;
};

}  // namespace gaitd::footsteps

#endif  // GAITD_FOOTSTEPS_STEP_RULES_H_
