// SPDX-License-Identifier: Apache-2.0
#include "heel_to_toe.h"

namespace gaitd::plugins {

HeelToToe::HeelToToe(const GaitdModel& model)
    : height_(model.nominal_com_height), reference_(model) {}

GaitdStatus HeelToToe::process(const GaitdIcpPlannerInput& in, GaitdIcpPlan& out) {
  walking::CmpOffsets offsets(height_);
  offsets.entry_x = p_[P::kEntryX];
  offsets.entry_y = p_[P::kEntryY];
  offsets.exit_x = p_[P::kExitX];
  offsets.exit_y = p_[P::kExitY];
  reference_.update(in.time.period, *in.robot, *in.gait, offsets, out);
  return GAITD_OK;
}

}  // namespace gaitd::plugins
