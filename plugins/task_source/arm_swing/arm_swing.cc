// SPDX-License-Identifier: Apache-2.0
#include "arm_swing.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/joint_chain.h"

namespace gaitd::plugins {
namespace {

using sdk::view;

constexpr double kFilter = 8.0;     // Hz, of the momentum: arms do not follow touchdowns
constexpr double kRateShare = 0.4;  // of the velocity limits
constexpr double kMargin = 0.1;     // rad, to the position limits
constexpr double kLargest = 0.7;    // rad, from the posture
constexpr double kReturn = 2.0;     // 1/s, with which the arms come back to their posture
constexpr double kResponse = 30.0;  // 1/s, with which the rates of the arms follow
constexpr double kLess = 1.05;      // by which the arms take less than their share

}  // namespace

ArmSwing::ArmSwing(const GaitdModel& model)
    : model_(model),
      player_(model),
      dynamics_(model),
      velocity_(Eigen::VectorXd::Zero(dynamics_.velocity_size())) {
  for (int hand = 0; hand < GAITD_MAX_HANDS; ++hand) {
    const walking::JointChain arm = walking::JointChain::arm(model, hand);
    for (int i = 0; i < arm.size(); ++i) {
      if (model.joints[arm.joint(i)].type == GAITD_JOINT_PRISMATIC) continue;  // no arm swings so
      Swing& s = swings_[count_++];
      s.joint = arm.joint(i);
      s.part = hand == GAITD_LEFT ? GAITD_PART_LEFT_ARM : GAITD_PART_RIGHT_ARM;
      s.nominal = arm.nominal()[i];
      s.least = std::min(arm.least(i) + kMargin, s.nominal);
      s.most = std::max(arm.most(i) - kMargin, s.nominal);
      s.fastest = kRateShare * arm.fastest()[i];
    }
  }
}

void ArmSwing::reset() {
  player_.reset();
  momentum_ = 0.0;
  for (Swing& s : swings_) s.offset = s.rate = 0.0;
}

double ArmSwing::yaw_momentum(const GaitdRobotState& robot) {
  dynamics_.update(robot);
  velocity_.head<6>() = view(robot.pelvis_twist);
  velocity_.tail(model_.joint_count) = sdk::head(robot.joint_velocity, model_.joint_count);
  for (int i = 0; i < count_; ++i) velocity_[dynamics::kBaseSize + swings_[i].joint] = 0.0;
  return dynamics_.centroidal_momentum_matrix().row(2).dot(velocity_);
}

GaitdStatus ArmSwing::process(const GaitdTaskSourceInput& in, GaitdTaskReferences& out) {
  const GaitdStatus status = player_.process(in, out);
  if (status != GAITD_OK || count_ == 0) return status;
  const double dt = in.time.period;
  const bool walks = in.gait->phase != GAITD_PHASE_STAND;
  const double now = walks ? yaw_momentum(*in.robot) : 0.0;
  momentum_ += -std::expm1(-2.0 * M_PI * kFilter * dt) * (now - momentum_);

  const auto row = dynamics_.centroidal_momentum_matrix().row(2);
  double inertia = 0.0;  // of the joints that may swing: the sum of the squares of their levers
  for (int i = 0; i < count_; ++i) {
    const double lever = row[dynamics::kBaseSize + swings_[i].joint];
    if (in.motions->parts[swings_[i].part].kind == GAITD_MOTION_NONE) inertia += lever * lever;
  }
  const double scale = inertia > 0.0 ? p_[P::kShare] * momentum_ / (kLess * inertia) : 0.0;
  for (int i = 0; i < count_; ++i) {
    Swing& s = swings_[i];
    const bool free = in.motions->parts[s.part].kind == GAITD_MOTION_NONE;
    const double lever = row[dynamics::kBaseSize + s.joint];
    const double pull = -kReturn * s.offset;
    const double wanted = std::clamp((free ? -scale * lever : 0.0) + pull, -s.fastest, s.fastest);
    const double before = s.rate;
    s.rate += -std::expm1(-kResponse * dt) * (wanted - s.rate);
    const double least = std::max(s.least - out.joint_position[s.joint], -kLargest);
    const double most = std::min(s.most - out.joint_position[s.joint], kLargest);
    const double to =
        std::clamp(s.offset + dt * s.rate, std::min(least, s.offset), std::max(most, s.offset));
    s.rate = (to - s.offset) / dt;
    s.offset = to;
    out.joint_position[s.joint] += s.offset;
    out.joint_velocity[s.joint] += s.rate;
    out.joint_acceleration[s.joint] += (s.rate - before) / dt;
  }
  return GAITD_OK;
}

void ArmSwing::get_state(GaitdTaskSourceState& state) const {
  player_.get_state(state);
  for (int i = 0; i < count_; ++i) {
    const Swing& s = swings_[i];
    if (state.parts[s.part].kind != GAITD_MOTION_NONE) continue;
    state.joint_position[s.joint] += s.offset;
    state.joint_velocity[s.joint] += s.rate;
  }
}

// What an arm that nobody moves is off its posture by, this variant brings back.
void ArmSwing::set_state(const GaitdTaskSourceState& state) {
  reset();
  GaitdTaskSourceState calm = state;
  for (int i = 0; i < count_; ++i) {
    Swing& s = swings_[i];
    if (state.parts[s.part].kind != GAITD_MOTION_NONE) continue;
    s.offset = state.joint_position[s.joint] - s.nominal;
    s.rate = state.joint_velocity[s.joint];
    calm.joint_position[s.joint] = s.nominal;
    calm.joint_velocity[s.joint] = 0.0;
  }
  player_.set_state(calm);
}

}  // namespace gaitd::plugins
