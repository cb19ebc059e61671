// SPDX-License-Identifier: Apache-2.0
#include "heel_to_toe.h"

namespace gaitd::plugins {

HeelToToe::HeelToToe(const GaitdModel& model) : reference_(model) {}

GaitdStatus HeelToToe::process(const GaitdIcpPlannerInput& in, GaitdIcpPlan& out) {
  const walking::CmpOffsets offsets{.entry_x = p_[P::kEntryX],
                                    .entry_y = p_[P::kEntryY],
                                    .exit_x = p_[P::kExitX],
                                    .exit_y = p_[P::kExitY],
                                    .exit_x_step_length = p_[P::kExitStepLength],
                                    .margin = p_[P::kMargin]};
  reference_.update(in.time.period, *in.robot, *in.gait, offsets, p_[P::kFit], out);
  return GAITD_OK;
}

}  // namespace gaitd::plugins
