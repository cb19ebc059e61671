// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <type_traits>

#include "gaitd/sdk/layer.h"
#include "inverse_dynamics_qp.h"
#include "null_space_projector.h"

namespace gaitd::plugins {

// Underconstrained whole-body controller (Griffin et al. 2018): tracks only the rows of the
// momentum that the mode asks for, and pulls what no task claims towards the privileged leg
// configuration. With the height left free the legs are as straight as they can be; with the pitch
// of the trailing foot left free it rolls over its toe. The tasks do not feel it:
//   min  … + |S (N vdot - vdot_p)|^2_Q     N: projector onto the null space of all tasks
class NullspaceQp {
 public:
  enum class P {
    kDamping,
    kTorqueScale,
    kJointAcceleration,
    kMaxIterations,
    kReferenceLeak,
    kFootFeedback,
    kCount
  };
  static constexpr std::array<GaitdParameter, 6> kParameters = {
      sdk::expert(sdk::real_parameter(
          "damping", "", 1e-5, 1, 0.005,
          "of the projector; low: knees jump near a singularity, high: they go limp")),
      kTorqueScaleParameter,
      kJointAccelerationParameter,
      kMaxIterationsParameter,
      kReferenceLeakParameter,
      kFootFeedbackParameter,
  };

  explicit NullspaceQp(const GaitdModel& model);
  void set_parameter(int index, double value) { p_.set(index, value); }
  GaitdStatus process(const GaitdWholeBodyControllerInput& in, GaitdWholeBodyControllerOutput& out);
  void reset() { qp_.reset(); }
  void get_state(GaitdWholeBodyControllerState& s) const { qp_.get_state(s); }
  void set_state(const GaitdWholeBodyControllerState& s) { qp_.set_state(s); }
  // As the last process() left it.
  const InverseDynamicsQp& problem() const { return qp_; }

 private:
  void add_privileged(const GaitdObjectives& objectives);

  const std::array<GaitdLeg, GAITD_MAX_FEET> legs_;
  sdk::Parameters<P> p_{kParameters};
  InverseDynamicsQp qp_;
  NullSpaceProjector projector_;
  static constexpr int kLegJoints = std::extent_v<decltype(GaitdLeg::joints)>;
  Eigen::MatrixXd rows_;  // of the projector, a column for each joint of a leg
};

}  // namespace gaitd::plugins
