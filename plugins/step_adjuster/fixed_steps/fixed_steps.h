// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "gaitd/sdk/layer.h"
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
  void reset();
  void get_state(GaitdStepAdjusterState& s) const;
  void set_state(const GaitdStepAdjusterState& s);

 private:
  static constexpr int kUnknownPhase = -1;

  walking::IcpFeedback feedback_;
  int phase_ = kUnknownPhase;  // in which it took over, of the step
  int32_t step_ = -1;
  Eigen::Vector3d shift_ = Eigen::Vector3d::Zero();  // m, taken over
  double time_shift_ = 0.0;                          // s, likewise
};

}  // namespace gaitd::plugins
