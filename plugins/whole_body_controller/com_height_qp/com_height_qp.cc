// SPDX-License-Identifier: Apache-2.0
#include "com_height_qp.h"

namespace gaitd::plugins {
namespace {

constexpr std::uint32_t kLinearRows = 0b111000;
constexpr std::uint32_t kHeightRow = 0b100000;

}  // namespace

ComHeightQp::ComHeightQp(const GaitdModel& model)
    : legs_{model.legs[GAITD_LEFT], model.legs[GAITD_RIGHT]}, qp_(model) {}

GaitdStatus ComHeightQp::process(const GaitdWholeBodyControllerInput& in,
                                 GaitdWholeBodyControllerOutput& out) {
  const GaitdObjectives& objectives = *in.objectives;
  qp_.begin(*in.robot, objectives, objectives.momentum_mask | kLinearRows,
            InverseDynamicsQp::limits_of(p_));
  // Where the mode leaves the height free, it asks of a leg that stands to be straight; here the
  // height says how far it is bent.
  const bool height_free = (objectives.momentum_mask & kHeightRow) == 0;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    if (height_free && InverseDynamicsQp::stands(objectives, side)) continue;
    for (int k = 0; k < legs_[side].joint_count; ++k) {
      const int i = legs_[side].joints[k];
      const double weight = p_[P::kPrivilegedScale] * objectives.privileged_weight[i];
      if (weight > 0.0) qp_.add_joint(i, objectives.privileged_acceleration[i], weight);
    }
  }
  qp_.solve(in.time.period, static_cast<int>(p_[P::kMaxIterations]));
  qp_.write(in.time.period, InverseDynamicsQp::drives_of(p_), *in.robot, objectives, out);
  return GAITD_OK;
}

}  // namespace gaitd::plugins
