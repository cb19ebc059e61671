// SPDX-License-Identifier: Apache-2.0
// Walking at a velocity: footsteps that are made anew at every touchdown, from where the foot is.
#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/gait_machine.h"
#include "gaitd/walking/support.h"

namespace gaitd::walking {
namespace {

constexpr int kAhead = kFootstepsOfDrive - 1;  // at the velocity, then one that closes
constexpr int kAttempts = 12;                  // to find a velocity that the legs can take
constexpr double kSlower = 0.85;               // from one attempt to the next
constexpr double kMadeGood = 0.03;  // m, of a landing beside its foothold; more is a new place

Velocity scaled(const Velocity& v, double factor) {
  return {factor * v.forward, factor * v.lateral, factor * v.turn};
}

GaitdPose level(const GaitdPose& pose) {
  GaitdPose result = pose;
  sdk::store(sdk::from_yaw(sdk::yaw_of(sdk::quaternion(pose.orientation))), result.orientation);
  return result;
}

// A renewal of a session that does not drive.
Refusal not_driving(RefusalReason why) {
  const char* what = why == RefusalReason::kNotRenewed
                         ? "it was not renewed in time, drive.timeout, and the robot stands"
                     : why == RefusalReason::kTakenOver
                         ? "another session has taken the robot over"
                         : "it has ended, by another command, a fault or its own end";
  Refusal refusal = refuse("drive: %s; begin anew: gaitctl drive", what);
  refusal.reason = why;
  return refusal;
}

}  // namespace

Refusal GaitMachine::drive(const VelocityCommand& command) {
  if (command.ends) {
    if (drive_.why_not(command.session) != RefusalReason::kNone) return {};
    drive_.let_go();
    drive_on(begun(), GAITD_BOTH);
    return {};
  }
  if (pending_mode_ == GAITD_MODE_STAND) {
    return refuse("drive: the gait mode is stand; choose one to walk in: gaitctl mode walk-bent");
  }
  if (state_.paused != 0) return refuse("drive: the walk is paused; go on first: gaitctl resume");
  if (command.renewal) {
    if (const RefusalReason why = drive_.why_not(command.session); why != RefusalReason::kNone) {
      return not_driving(why);
    }
  }
  if (drive_.take(command, step_under_way())) drive_on(begun(), GAITD_BOTH);
  return {};
}

VelocityWalk::Step GaitMachine::step_under_way() const {
  if (begun() == 0) return {{}, model_.nominal_foot_separation};
  const GaitdFootstep& step = queue_[0];
  const GaitdPose& from = state_.footholds[step.side].pose;
  const GaitdPose& beside = state_.footholds[other_side(step.side)].pose;
  const Eigen::Quaterniond heading =
      sdk::from_yaw(sdk::yaw_of(sdk::quaternion(step.pose.orientation)));
  const auto seen = [&](const GaitdPose& pose) -> Eigen::Vector3d {
    return heading.conjugate() * (sdk::view(step.pose.position) - sdk::view(pose.position));
  };
  // The middle of the feet moves by half of what the foot does.
  const double rate = 0.5 / (step.swing_duration + step.transfer_duration);
  const Eigen::Vector3d way = rate * seen(from);
  const double turn = rate * sdk::yaw_of(sdk::quaternion(from.orientation).conjugate() * heading);
  return {{way.x(), way.y(), turn}, std::abs(seen(beside).y())};
}

GaitdFootstep GaitMachine::drive_step(const GaitdPose& middle, int side,
                                      const VelocityWalk::Step& step, double duration) const {
  const Velocity& v = step.velocity;
  // The way first, then the turn: the body faces half-way between the feet, half a turn behind.
  const GaitdPose next =
      moved(middle, v.forward * duration, v.lateral * duration, v.turn * duration);
  GaitdFootstep result{};
  result.side = side;
  result.pose = moved(next, 0.0, 0.5 * side_sign(side) * step.width, 0.0);
  return result;
}

void GaitMachine::drive_on(int kept, int landed, const Eigen::Vector3d& missed) {
  keep_first(kept);
  routed_ = false;
  returns_left_ = 0;  // a velocity leads nowhere
  GaitdPose feet[2] = {state_.footholds[GAITD_LEFT].pose, state_.footholds[GAITD_RIGHT].pose};
  for (GaitdPose& foot : feet) foot.position[2] -= height_offset_;
  if (kept > 0) {
    landed = queue_[0].side;
    feet[landed] = queue_[0].pose;
  }
  const double duration = parameters_[Gait::kSwingDuration] + parameters_[Gait::kTransferDuration];
  VelocityWalk::Step step = drive_.step();
  GaitdPose middle = landed == GAITD_BOTH ? middle_pose(feet[GAITD_LEFT], feet[GAITD_RIGHT])
                                          : moved(level(feet[landed]), 0.0,
                                                  -0.5 * side_sign(landed) * step.width, 0);
  // A centimetre that every step misses by is not to be lost at every step.
  const double distance = missed.head<2>().norm();
  const double made_good = distance > kMadeGood ? kMadeGood / distance : 1.0;
  sdk::view(middle.position).head<2>() -= made_good * missed.head<2>();
  drive_.set_limit({});
  int count = 0;
  for (; count < kAhead; ++count) {
    Velocity v = drive_.next(step.velocity, duration);
    if (drive_.at_rest(v)) break;
    // Into the walk with the foot on the side it goes to, so that the legs never close first.
    const bool left = v.lateral > 0.0 || (v.lateral == 0.0 && v.turn > 0.0);
    const int side = landed != GAITD_BOTH ? other_side(landed) : left ? GAITD_LEFT : GAITD_RIGHT;
    if (landed == GAITD_BOTH) middle.position[2] = first_level(feet, side);
    GaitdFootstep footstep;
    Refusal refusal;
    for (int attempt = 0; attempt < kAttempts; ++attempt, v = scaled(v, kSlower)) {
      step = {v, drive_.width(v, duration, limits().least_separation)};
      footstep = drive_step(middle, side, step, duration);
      refusal = check(footstep, feet[other_side(side)], feet[side], count + 1);
      if (!refusal.refused()) refusal = check_capture(&footstep, 1, queue_.size(), count + 1);
      if (!refusal.refused()) break;
      drive_.set_limit(refusal);
    }
    if (refusal.refused()) break;
    if (kept == 0 && count == 0) drive_.begin(step);
    middle = moved(footstep.pose, 0.0, -0.5 * side_sign(side) * step.width, 0.0);
    feet[side] = footstep.pose;
    landed = side;
    complete(footstep);
    queue_.push(footstep);
  }
  if (kept == 0 && count == 0) drive_.begin({{}, model_.nominal_foot_separation});
  if (landed != GAITD_BOTH) {
    const int side = other_side(landed);
    GaitdFootstep closing = closing_step(feet[landed], side);
    const Eigen::Vector3d gap = sdk::view(feet[side].position) - sdk::view(closing.pose.position);
    if (gap.head<2>().norm() > kNoClosingStep) {
      complete(closing);
      queue_.push(closing);
    }
  }
  publish_footsteps();
  changed();
}

void GaitMachine::rest_or_drive_on() {
  if (!drive_.idle()) return drive_on(begun(), GAITD_BOTH);
  if (drive_.timed_out()) drive_.finish();
}

}  // namespace gaitd::walking
