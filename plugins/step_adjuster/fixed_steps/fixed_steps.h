// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "gaitd/sdk/layer.h"
#include "gaitd/sdk/views.h"
#include "gaitd/walking/icp_feedback.h"

namespace gaitd::plugins {

// ICP feedback by moving the CMP only; footsteps and timing stay as commanded. What another variant
// has moved in the phase in which this one takes over stays moved: the foot is on its way there.
class FixedSteps {
 public:
  static constexpr auto kParameters = walking::kFeedbackParameters;

  explicit FixedSteps(const GaitdModel& model) : feedback_(model) {}
  void set_parameter(int index, double value) { feedback_.set_parameter(index, value); }
  GaitdStatus process(const GaitdStepAdjusterInput& in, GaitdStepAdjustment& out);
  void reset() {
    feedback_.reset();
    phase_ = kUnknownPhase;
    kept_shift_.setZero();
    kept_time_shift_ = 0.0;
  }
  void get_state(GaitdStepAdjusterState& s) const {
    feedback_.get_state(s);
    s.step_index = step_;
    sdk::view(s.shift) = kept_shift_;
    s.time_shift = kept_time_shift_;
  }
  void set_state(const GaitdStepAdjusterState& s) {
    feedback_.set_state(s);
    phase_ = kUnknownPhase;
    step_ = s.step_index;
    kept_shift_ = sdk::view(s.shift);
    kept_time_shift_ = s.time_shift;
  }

 private:
  static constexpr int kUnknownPhase = -1;

  walking::IcpFeedback feedback_;
  int phase_ = kUnknownPhase;  // in which it took over, of the step
  int32_t step_ = -1;
  Eigen::Vector3d kept_shift_ = Eigen::Vector3d::Zero();  // m, taken over
  double kept_time_shift_ = 0.0;                          // s, likewise
};

}  // namespace gaitd::plugins
