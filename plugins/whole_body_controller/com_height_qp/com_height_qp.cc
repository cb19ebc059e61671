// SPDX-License-Identifier: Apache-2.0
#include "com_height_qp.h"

namespace gaitd::plugins {

ComHeightQp::ComHeightQp(const GaitdModel& model) : joints_(model.joint_count), qp_(model) {}

GaitdStatus ComHeightQp::process(const GaitdWholeBodyControllerInput& in,
                                 GaitdWholeBodyControllerOutput& out) {
  const GaitdObjectives& objectives = *in.objectives;
  constexpr std::uint32_t kLinearRows = 0b111000;
  qp_.begin(*in.robot, objectives, objectives.momentum_mask | kLinearRows,
            InverseDynamicsQp::limits_of(p_));
  for (int i = 0; i < joints_; ++i) {
    const double weight = p_[P::kPrivilegedScale] * objectives.privileged_weight[i];
    if (weight > 0.0) qp_.add_joint(i, objectives.privileged_acceleration[i], weight);
  }
  qp_.solve(in.time.period, static_cast<int>(p_[P::kMaxIterations]));
  qp_.write(in.time.period, InverseDynamicsQp::drives_of(p_), *in.robot, objectives, out);
  return GAITD_OK;
}

}  // namespace gaitd::plugins
