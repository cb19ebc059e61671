// SPDX-License-Identifier: Apache-2.0
#include "fixed_steps.h"

namespace gaitd::plugins {

GaitdStatus FixedSteps::process(const GaitdStepAdjusterInput& in, GaitdStepAdjustment& out) {
  if (phase_ != kUnknownPhase && phase_ != in.gait->phase) {
    GaitdStepAdjusterState state{};
    feedback_.get_state(state);
    state.step_index = -1;
    state.shift[0] = state.shift[1] = state.shift[2] = 0.0;
    state.time_shift = 0.0;
    feedback_.set_state(state);
  }
  phase_ = in.gait->phase;
  feedback_.update(in, out);
  return GAITD_OK;
}

}  // namespace gaitd::plugins
