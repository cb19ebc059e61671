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
  void reset() {
    feedback_.reset();
    phase_ = kUnknownPhase;
  }
  void get_state(GaitdStepAdjusterState& s) const { feedback_.get_state(s); }
  void set_state(const GaitdStepAdjusterState& s) {
    feedback_.set_state(s);
    phase_ = kUnknownPhase;
  }

 private:
  static constexpr int kUnknownPhase = -1;

  walking::IcpFeedback feedback_;
  // What somebody else has shifted is kept for him until the phase ends.
  int phase_ = kUnknownPhase;
};

}  // namespace gaitd::plugins
