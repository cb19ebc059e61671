// SPDX-License-Identifier: Apache-2.0
#include "fixed_steps.h"

namespace gaitd::plugins {

GaitdStatus FixedSteps::process(const GaitdStepAdjusterInput& in, GaitdStepAdjustment& out) {
  const GaitdGaitState& gait = *in.gait;
  if (phase_ == kUnknownPhase) phase_ = gait.phase;
  if (phase_ != gait.phase || step_ != gait.step_index) {
    kept_shift_.setZero();
    kept_time_shift_ = 0.0;
  }
  feedback_.update(in, out);
  if (kept_shift_.isZero(0.0) && kept_time_shift_ == 0.0) return GAITD_OK;
  out.active = 1;
  sdk::view(out.shift) = kept_shift_;
  out.time_shift = kept_time_shift_;
  return GAITD_OK;
}

}  // namespace gaitd::plugins
