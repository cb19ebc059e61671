// SPDX-License-Identifier: Apache-2.0
#include "single_cmp.h"

namespace gaitd::plugins {

GaitdStatus SingleCmp::process(const GaitdIcpPlannerInput& in, GaitdIcpPlan& out) {
  walking::CmpOffsets middle(height_);
  middle.entry_x = middle.exit_x = 0.0;
  middle.entry_y = middle.exit_y = p_[P::kInwards];
  reference_.update(in.time.period, *in.robot, *in.gait, middle, out);
  return GAITD_OK;
}

}  // namespace gaitd::plugins
