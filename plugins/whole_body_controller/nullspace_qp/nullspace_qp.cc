// SPDX-License-Identifier: Apache-2.0
#include "nullspace_qp.h"

namespace gaitd::plugins {
namespace {

constexpr double kLittleFreedom = 0.05;  // of the projector's trace, in the joints of one leg
// Of the joints of a leg that swings: its foot is for them to move. The height of the hip, which no
// task claims, would otherwise take its share, and a foot that is lifted off bent legs would throw
// the robot up.
constexpr double kSwingEase = 1.25;

}  // namespace

NullspaceQp::NullspaceQp(const GaitdModel& model)
    : legs_{model.legs[GAITD_LEFT], model.legs[GAITD_RIGHT]},
      qp_(model),
      projector_(6 + model.joint_count, InverseDynamicsQp::kMaxRows),
      rows_(6 + model.joint_count, kLegJoints) {}

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

// The target is not projected: then the weights say which leg counts, as in the paper. Projected,
// a single freedom would take the mean of both legs, whatever their weights.
void NullspaceQp::add_privileged(const GaitdObjectives& objectives) {
  projector_.clear();
  qp_.claim(objectives, projector_);
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    if (InverseDynamicsQp::stands(objectives, side)) continue;
    for (int k = 0; k < legs_[side].joint_count; ++k) {
      projector_.ease(6 + legs_[side].joints[k], kSwingEase);
    }
  }
  projector_.compute(p_[P::kDamping]);
  for (const GaitdLeg& leg : legs_) {
    double freedom = 0.0;
    for (int k = 0; k < leg.joint_count; ++k) {
      const int i = leg.joints[k];
      if (objectives.privileged_weight[i] <= 0.0) continue;
      projector_.row(6 + i, rows_.col(k));
      freedom += rows_(6 + i, k);
    }
    // A leg of which the tasks leave nothing would ask for the more.
    const double share = freedom / (freedom + kLittleFreedom);
    for (int k = 0; k < leg.joint_count; ++k) {
      const int i = leg.joints[k];
      if (objectives.privileged_weight[i] <= 0.0) continue;
      qp_.add_row(rows_.col(k), share * objectives.privileged_acceleration[i],
                  objectives.privileged_weight[i]);
    }
  }
}

}  // namespace gaitd::plugins
