// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gaitd/sdk/layer.h"
#include "inverse_dynamics_qp.h"

namespace gaitd::plugins {

// Whole-body controller with a commanded CoM height: the linear momentum rate is tracked in x, y
// and z whatever the mode says, and the privileged leg configuration is an ordinary task of low
// weight. The bent-knee baseline (Koolen et al. 2016).
class ComHeightQp {
 public:
  enum class P {
    kPrivilegedScale,
    kJointRateGain,
    kHorizon,
    kJointAcceleration,
    kBaseAcceleration,
    kTorqueScale,
    kMaxIterations,
    kReferenceLeak,
    kCount
  };
  static constexpr std::array<GaitdParameter, 8> kParameters = {
      sdk::real_parameter("privileged_scale", "", 0, 10, 0.1,
                          "of the privileged weights; small: it must not disturb the tasks"),
      sdk::real_parameter("joint_rate_gain", "1/s", 1, 500, 30,
                          "allowed joint rate per distance to a position limit"),
      sdk::real_parameter("limit_horizon", "s", 0.001, 1, 0.02,
                          "in which a joint may reach its allowed rate"),
      sdk::real_parameter("joint_acceleration_limit", "rad/s^2", 10, 1e5, 2000, "of every joint"),
      sdk::real_parameter("base_acceleration_limit", "m/s^2", 10, 1e5, 1000,
                          "of the pelvis, also in rad/s^2"),
      sdk::real_parameter("torque_scale", "", 0.05, 1, 1, "share of the effort limits in use"),
      sdk::integer_parameter("max_iterations", "", 10, 10000, 300,
                             "changes of the active set after which the solver gives up"),
      sdk::real_parameter("reference_leak", "1/s", 0, 1000, 8,
                          "with which the references of the drives follow the joints"),
  };

  explicit ComHeightQp(const GaitdModel& model);
  void set_parameter(int index, double value) { p_.set(index, value); }
  GaitdStatus process(const GaitdWholeBodyControllerInput& in, GaitdWholeBodyControllerOutput& out);
  void reset() { qp_.reset(); }
  void get_state(GaitdWholeBodyControllerState& s) const { qp_.get_state(s); }
  void set_state(const GaitdWholeBodyControllerState& s) { qp_.set_state(s); }

 private:
  const int joints_;
  sdk::Parameters<P> p_{kParameters};
  InverseDynamicsQp qp_;
};

}  // namespace gaitd::plugins
