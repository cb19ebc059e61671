// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "gaitd/sdk/layer.h"
#include "inverse_dynamics_qp.h"

namespace gaitd::plugins {

// Whole-body controller with a commanded CoM height: the linear momentum rate is tracked in x, y
// and z whatever the mode says, and the privileged leg configuration is an ordinary task of low
// weight, for legs that do not stand where the mode leaves the height free. The bent-knee baseline
// (Koolen et al. 2016).
class ComHeightQp {
 public:
  enum class P {
    kPrivilegedScale,
    kTorqueScale,
    kJointAcceleration,
    kMaxIterations,
    kReferenceLeak,
    kFootFeedback,
    kCount
  };
  static constexpr std::array<GaitdParameter, 6> kParameters = {
      sdk::expert(sdk::real_parameter(
          "privileged_scale", "", 0, 10, 0.1,
          "of the privileged weights; low: knees drift, high: tasks are disturbed")),
      kTorqueScaleParameter,
      kJointAccelerationParameter,
      kMaxIterationsParameter,
      kReferenceLeakParameter,
      kFootFeedbackParameter,
  };

  explicit ComHeightQp(const GaitdModel& model);
  void set_parameter(int index, double value) { p_.set(index, value); }
  GaitdStatus process(const GaitdWholeBodyControllerInput& in, GaitdWholeBodyControllerOutput& out);
  void reset() { qp_.reset(); }
  void get_state(GaitdWholeBodyControllerState& s) const { qp_.get_state(s); }
  void set_state(const GaitdWholeBodyControllerState& s) { qp_.set_state(s); }

 private:
  const std::array<GaitdLeg, GAITD_MAX_FEET> legs_;
  sdk::Parameters<P> p_{kParameters};
  InverseDynamicsQp qp_;
};

}  // namespace gaitd::plugins
