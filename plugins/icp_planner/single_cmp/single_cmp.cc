// SPDX-License-Identifier: Apache-2.0
#include "single_cmp.h"

namespace gaitd::plugins {

GaitdStatus SingleCmp::process(const GaitdIcpPlannerInput& in, GaitdIcpPlan& out) {
  const walking::CmpOffsets middle{
      .entry_x = 0.0, .entry_y = p_[P::kInwards], .exit_x = 0.0, .exit_y = p_[P::kInwards]};
  reference_.update(in.time.period, *in.robot, *in.gait, middle, out);
  return GAITD_OK;
}

}  // namespace gaitd::plugins
