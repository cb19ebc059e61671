// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/velocity_walk.h"

#include <algorithm>
#include <cmath>

namespace gaitd::walking {
namespace {

constexpr double kBackwards = 0.5;  // of the speed forwards
// Of √(g h), and of √(g / h): slower is standing.
constexpr double kStill = 1e-3;

double toward(double from, double to, double step) {
  return from + std::clamp(to - from, -step, step);
}

}  // namespace

VelocityWalk::VelocityWalk(const GaitdModel& model)
    : speed_(std::sqrt(model.gravity * model.nominal_com_height)),
      rate_(std::sqrt(model.gravity / model.nominal_com_height)),
      height_(model.nominal_com_height),
      gravity_(model.gravity),
      separation_(model.nominal_foot_separation) {}

Velocity VelocityWalk::bounded(const Velocity& asked) {
  const double forward = parameters_[Drive::kMaxForward] * speed_;
  const double lateral = parameters_[Drive::kMaxLateral] * speed_;
  const double turn = parameters_[Drive::kMaxTurn] * rate_;
  const Velocity v{std::clamp(asked.forward, -kBackwards * forward, forward),
                   std::clamp(asked.lateral, -lateral, lateral),
                   std::clamp(asked.turn, -turn, turn)};
  bound_ = {};
  if (v.forward != asked.forward || v.lateral != asked.lateral || v.turn != asked.turn) {
    bound_ = refuse(
        "slower than asked: %.2f m/s forwards, %.2f m/s to the left, %.2f rad/s to the left, by "
        "drive.max_forward, drive.max_lateral, drive.max_turn",
        v.forward, v.lateral, v.turn);
  }
  return v;
}

bool VelocityWalk::take(const VelocityCommand& command, const Step& other) {
  const Velocity before = target_;
  const bool began = !active_;
  if (began) step_ = other;
  active_ = true;
  session_ = command.session;
  holds_ = command.holds;
  let_go_ = false;
  age_ = 0.0;
  target_ = bounded(command.velocity);
  return began || target_.forward != before.forward || target_.lateral != before.lateral ||
         target_.turn != before.turn;
}

RefusalReason VelocityWalk::why_not(std::int64_t session) const {
  if (!active_) return session == session_ ? ended_ : RefusalReason::kEnded;
  if (session != session_) return RefusalReason::kTakenOver;
  return let_go_ ? RefusalReason::kEnded : RefusalReason::kNone;
}

void VelocityWalk::let_go() {
  let_go_ = true;
  target_ = {};
  bound_ = {};
}

void VelocityWalk::end(RefusalReason why) {
  if (active_) ended_ = why;
  active_ = false;
  target_ = {};
  step_ = {{}, separation_};
  limit_ = {};
  bound_ = {};
}

bool VelocityWalk::wait(double dt) {
  if (!active_ || timed_out()) return false;
  age_ += dt;
  if (!timed_out()) return false;
  target_ = {};
  return true;
}

Velocity VelocityWalk::next(const Velocity& before, double duration) const {
  const double change = parameters_[Drive::kAcceleration] * gravity_ * duration;
  return {toward(before.forward, target_.forward, change),
          toward(before.lateral, target_.lateral, change),
          toward(before.turn, target_.turn, change / height_)};
}

bool VelocityWalk::at_rest(const Velocity& v) const {
  return std::max(std::abs(v.forward), std::abs(v.lateral)) < kStill * speed_ &&
         std::abs(v.turn) < kStill * rate_;
}

double VelocityWalk::width(const Velocity& velocity, double duration, double least) const {
  return std::max(separation_, std::abs(velocity.lateral) * duration + least);
}

}  // namespace gaitd::walking
