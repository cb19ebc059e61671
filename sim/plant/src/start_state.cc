// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/start_state.h"

#include <algorithm>

namespace gaitd::sim {
namespace {

constexpr double kRounding = 1e-3;  // m
constexpr double kLowering = 1e-5;  // m

}  // namespace

State make_start_state(const GaitdModel& model, const Config& config, Physics* physics) {
  State state;
  state.q = Eigen::Map<const Eigen::VectorXd>(model.nominal_position, model.joint_count);
  state.u = Eigen::VectorXd::Zero(6 + model.joint_count);
  state.R_WB = Eigen::AngleAxisd(config.start.yaw, Eigen::Vector3d::UnitZ());
  physics->place(state);
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double lowest = 1e9;
  for (const GaitdFoot& foot : model.feet) {
    const Eigen::Vector3d sole =
        physics->bodies()[foot.sole.body].point(Eigen::Vector3d(foot.sole.origin));
    middle += 0.5 * sole;
    lowest = std::min(lowest, sole.z());
  }
  const double height = config.start.z ? *config.start.z : config.terrain.ground_z.value_or(0);
  const auto stands = [&] {
    physics->place(state);
    bool touches[GAITD_MAX_FEET] = {};
    for (const Touch& touch : physics->touches()) {
      if (touch.foot >= 0) touches[touch.foot] = true;
    }
    return touches[GAITD_LEFT] && touches[GAITD_RIGHT];
  };
  state.p_WB = Eigen::Vector3d(config.start.x - middle.x(), config.start.y - middle.y(),
                               height - physics->resting_depth() - lowest);
  if (config.start.hoist) {
    state.p_WB.z() = height + config.start.hoist->height - lowest;
    physics->place(state);
    return state;
  }
  // Heights in scenarios are rounded: a hair above the ground is meant to be on it.
  const double written = state.p_WB.z();
  while (!stands()) {
    state.p_WB.z() -= kLowering;
    if (state.p_WB.z() > written - kRounding) continue;
    state.p_WB.z() = written;  // it is meant to fall
    break;
  }
  return state;
}

}  // namespace gaitd::sim
