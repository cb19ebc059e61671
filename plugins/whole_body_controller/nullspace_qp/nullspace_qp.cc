// SPDX-License-Identifier: Apache-2.0
#include "nullspace_qp.h"

namespace gaitd::plugins {

NullspaceQp::NullspaceQp(const GaitdModel& model)
    : joints_(model.joint_count),
      qp_(model),
      projector_(6 + model.joint_count, InverseDynamicsQp::kMaxRows),
      row_(6 + model.joint_count) {}

GaitdStatus NullspaceQp::process(const GaitdWholeBodyControllerInput& in,
                                 GaitdWholeBodyControllerOutput& out) {
  const GaitdObjectives& objectives = *in.objectives;
  qp_.begin(*in.robot, objectives, objectives.momentum_mask, InverseDynamicsQp::limits_of(p_));
  add_privileged(objectives);
  qp_.solve(in.time.period, static_cast<int>(p_[P::kMaxIterations]));
  qp_.write(in.time.period, InverseDynamicsQp::drives_of(p_), *in.robot, objectives, out);
  out.info.null_trace = projector_.trace();
  return GAITD_OK;
}

void NullspaceQp::add_privileged(const GaitdObjectives& objectives) {
  projector_.clear();
  qp_.claim(objectives, projector_);
  projector_.compute(p_[P::kDamping]);
  for (int i = 0; i < joints_; ++i) {
    if (objectives.privileged_weight[i] <= 0.0) continue;
    projector_.row(6 + i, row_);
    double target = 0.0;
    for (int j = 0; j < joints_; ++j) {
      if (objectives.privileged_weight[j] > 0.0) {
        target += row_[6 + j] * objectives.privileged_acceleration[j];
      }
    }
    qp_.add_row(row_, target, objectives.privileged_weight[i]);
  }
}

}  // namespace gaitd::plugins
