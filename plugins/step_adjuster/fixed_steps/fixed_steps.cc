// SPDX-License-Identifier: Apache-2.0
#include "fixed_steps.h"

#include "gaitd/sdk/views.h"

namespace gaitd::plugins {

GaitdStatus FixedSteps::process(const GaitdStepAdjusterInput& in, GaitdStepAdjustment& out) {
  const GaitdGaitState& gait = *in.gait;
  if (phase_ == kUnknownPhase) {
    phase_ = gait.phase;
    step_ = gait.step_index;
  }
  if (phase_ != gait.phase || step_ != gait.step_index) {
    shift_.setZero();
    time_shift_ = 0.0;
  }
  feedback_.update(in, out);
  if (shift_.isZero(0.0) && time_shift_ == 0.0) return GAITD_OK;
  out.active = 1;
  sdk::view(out.shift) = shift_;
  out.time_shift = time_shift_;
  return GAITD_OK;
}

void FixedSteps::reset() {
  feedback_.reset();
  phase_ = kUnknownPhase;
  shift_.setZero();
  time_shift_ = 0.0;
}

void FixedSteps::get_state(GaitdStepAdjusterState& s) const {
  feedback_.get_state(s);
  s.step_index = step_;
  sdk::view(s.shift) = shift_;
  s.time_shift = time_shift_;
}

void FixedSteps::set_state(const GaitdStepAdjusterState& s) {
  feedback_.set_state(s);
  phase_ = kUnknownPhase;
  step_ = s.step_index;
  shift_ = sdk::view(s.shift);
  time_shift_ = s.time_shift;
}

}  // namespace gaitd::plugins
