// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gaitd/sdk/layer.h"
#include "gaitd/walking/icp_feedback.h"

namespace gaitd::plugins {

// ICP feedback by moving the CMP only; footsteps and timing stay as commanded.
class FixedSteps {
 public:
  static constexpr auto kParameters = walking::kFeedbackParameters;

  explicit FixedSteps(const GaitdModel& model) : feedback_(model) {}
  void set_parameter(int index, double value) { feedback_.set_parameter(index, value); }
  GaitdStatus process(const GaitdStepAdjusterInput& in, GaitdStepAdjustment& out);
  void reset() { feedback_.reset(); }
  // It has shifted nothing, whatever it took over.
  void get_state(GaitdStepAdjusterState& s) const {
    feedback_.get_state(s);
    s.step_index = -1;
    s.shift[0] = s.shift[1] = s.shift[2] = 0.0;
    s.time_shift = 0.0;
  }
  void set_state(const GaitdStepAdjusterState& s) { feedback_.set_state(s); }

 private:
  walking::IcpFeedback feedback_;
};

}  // namespace gaitd::plugins
