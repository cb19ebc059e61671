// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/gait_machine.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/icp_feedback.h"
#include "gaitd/walking/support.h"

namespace gaitd::walking {
namespace {

// Of the distance of the feet in the nominal posture: the gap that is left between two soles side
// by side.
constexpr double kSolesApart = 0.05;

// Over sqrt(g h), h the height of the CoM: a foot that is faster is still on its way.
constexpr double kLandedRise = 0.05;
constexpr double kLandedSlide = 0.15;
constexpr double kLandedFirmly = 3.0;
// Of √(g h): the speed that the foot may lose to a knee at its stop. Its own force sensor shows the
// impulse of it, and no more than that is needed to say that the load is the ground's.
constexpr double kLandedStop = 0.2;

// Heights of the CoM, of the ICP error along the walk and across it that lets a transfer end in
// time.
constexpr double kReadyAlong = 0.04247;
constexpr double kReadyAcross = 0.02548;
constexpr double kReadyFor = 0.01;  // s, that it has to last: a measured ICP is noisy

// ICP closer than this to the edge of both feet is not held by them (m).
constexpr double kHeldMargin = 0.01;

}  // namespace

GaitMachine::GaitMachine(const GaitdModel& model)
    : model_(model),
      parameters_(kGaitParameters),
      timing_(model),
      step_check_(model),
      capture_check_(model),
      drive_(model),
      scale_(model) {
  closest_ = kSolesApart * model.nominal_foot_separation;
  for (const GaitdFoot& foot : model.feet) {
    double inner = 0.0, outer = 0.0;
    for (int i = 0; i < foot.point_count; ++i) {
      inner = std::min(inner, foot.points[i][1]);
      outer = std::max(outer, foot.points[i][1]);
    }
    closest_ += 0.5 * (outer - inner);
  }
  state_.size = sizeof(state_);
  state_.mode = GAITD_MODE_WALK_BENT;
  state_.next_side = GAITD_BOTH;
  state_.trailing_side = GAITD_BOTH;
  state_.support = GAITD_BOTH;
  state_.omega = 1.0 / (std::sqrt(kWalkingHeight) * scale_.time);
  for (auto& foothold : state_.footholds) {
    foothold.pose.orientation[3] = 1.0;
    foothold.contact = GAITD_CONTACT_FULL;
  }
}

void GaitMachine::keep_first(int kept) {
  queue_.truncate(kept);
  own_steps_ = std::min(own_steps_, kept);
  if (kept == 0) path_offset_.setZero();
  for (int i = 2 * kept; i < StepTiming::kPhases; ++i) time_changes_[i] = 0.0;
}

void GaitMachine::set_parameter(int index, double value) { parameters_.set(index, value); }

void GaitMachine::reset(const GaitdRobotState& robot) {
  queue_.truncate(0);
  drive_.end();
  routed_ = false;
  shift_.setZero();
  path_offset_.setZero();
  time_shift_ = 0.0;
  height_offset_ = 0.0;
  time_unheld_ = 0.0;
  own_steps_ = 0;
  state_.step_index = 0;
  state_.paused = 0;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    GaitdPose pose;
    sdk::view(pose.position) = sdk::view(robot.feet[side].position);
    sdk::store(sdk::quaternion(robot.feet[side].orientation), pose.orientation);
    state_.footholds[side] = told_[side] = on_line(model_, side, whole_sole(model_, side, pose));
    contacts_[side].land(0.0);
  }
  begin_stand();
}

void GaitMachine::apply_pending_mode() { state_.mode = pending_mode_; }

void GaitMachine::begin_stand() {
  apply_pending_mode();
  goals_ = {};
  state_.phase = GAITD_PHASE_STAND;
  state_.support = GAITD_BOTH;
  state_.next_side = GAITD_BOTH;
  state_.trailing_side = GAITD_BOTH;
  state_.transfer_final = 0;
  state_.time_in_phase = 0.0;
  state_.phase_duration = 0.0;
  state_.time_remaining = 0.0;
  state_.early_contact = 0;
  state_.late_contact = 0;
  changed();
  publish_footsteps();
}

void GaitMachine::begin_transfer(const GaitdRobotState& robot, int trailing_side) {
  const bool final = queue_.size() == 0 || (state_.paused != 0 && !recovering());
  state_.phase = GAITD_PHASE_TRANSFER;
  state_.support = GAITD_BOTH;
  state_.trailing_side = trailing_side;
  state_.transfer_final = final ? 1 : 0;
  state_.time_in_phase = 0.0;
  time_shift_ = 0.0;
  time_changes_ = {};
  state_.final_transfer_duration = kFinalTransfer;
  if (final) {
    state_.phase_duration = state_.final_transfer_duration;
    state_.next_side = GAITD_BOTH;
  } else {
    state_.phase_duration = queue_[0].transfer_duration;
    if (trailing_side == GAITD_BOTH && !recovering()) {
      state_.phase_duration = std::max(state_.phase_duration, kInitialTransfer);
    }
    state_.next_side = queue_[0].side;
    ++state_.step_index;
  }
  publish_footsteps();
  if (!final) time_step(robot);
  state_.time_remaining = state_.phase_duration;
  changed();
}

void GaitMachine::time_step(const GaitdRobotState& robot) {
  const bool wanted =
      parameters_.flag(Gait::kStepTiming) && state_.mode == GAITD_MODE_WALK_STRAIGHT;
  if (!wanted || recovering()) return;
  time_changes_ = timing_.solve(state_, sdk::view(robot.com).head<2>(), {});
  state_.phase_duration += time_changes_[0];
  publish_footsteps();
}

void GaitMachine::begin_swing(const GaitdRobotState& robot) {
  const int side = queue_[0].side;
  state_.phase = GAITD_PHASE_SWING;
  state_.support = other_side(side);
  state_.next_side = side;
  state_.time_in_phase = 0.0;
  state_.phase_duration = queue_[0].swing_duration + time_changes_[1];
  state_.time_remaining = state_.phase_duration;
  state_.early_contact = 0;
  state_.late_contact = 0;
  state_.footholds[side].contact = GAITD_CONTACT_NONE;
  contacts_[side].reset();
  landed_impulse_ = 0.0;
  ready_time_ = 0.0;
  shift_ = path_offset_;
  time_shift_ = 0.0;
  sdk::view(lift_off_.position) = sdk::view(robot.feet[side].position);
  sdk::store(sdk::quaternion(robot.feet[side].orientation), lift_off_.orientation);
  changed();
  publish_footsteps();
}

void GaitMachine::touch_down(const GaitdRobotState& robot, bool early) {
  GaitdFootstep landed = state_.adjusted[0];
  const int side = landed.side;
  // The ground is where the foot met it: later footholds keep their heights relative to this one.
  const double height_error = robot.feet[side].position[2] - landed.pose.position[2];
  height_offset_ += height_error;
  contacts_[side].land(height_error / model_.nominal_com_height);
  const Eigen::Vector3d missed =
      sdk::view(robot.feet[side].position) - sdk::view(landed.pose.position);
  sdk::view(landed.pose.position) = sdk::view(robot.feet[side].position);
  state_.footholds[side] = told_[side] = bearing_of(model_, landed);
  state_.early_contact = early ? 1 : 0;
  const bool own = recovering();
  if (own) {
    contacts_[side].doubt();
    goals_[side].stood_on = false;
    --own_steps_;
  } else {
    goals_[side] = {queue_[0], true, !drive_.active()};
  }
  queue_.pop();
  path_offset_.setZero();
  Eigen::Vector3d shift = shift_;
  if (recovering()) shift.head<2>() += missed.head<2>();  // the closing step is beside this foot
  if (queue_.size() > 0) path_offset_ = offset_of(0, shift, landed.pose);
  if (recovering() && queue_.size() == 1 && closed()) keep_first(0);
  // The way of a velocity begins anew where the foot is.
  if (drive_.active() && !own) drive_on(0, side, missed);
  time_shift_ = 0.0;
  apply_pending_mode();
  begin_transfer(robot, other_side(side));
}

Eigen::Quaterniond GaitMachine::heading() const {
  return sdk::quaternion(
      middle_pose(state_.footholds[GAITD_LEFT].pose, state_.footholds[GAITD_RIGHT].pose)
          .orientation);
}

// m, of an ICP that has not come over the leading foot: what this foot's CMP brings back until the
// other one lands.
double GaitMachine::ready_across(const GaitdIcpPlan& plan) const {
  const int side = other_side(state_.next_side);
  const double growth = std::exp(state_.omega * state_.adjusted[0].swing_duration);
  const Eigen::Vector2d cmp =
      planned_cmp(sdk::view(plan.icp_end), sdk::view(plan.icp_touchdown), growth);
  ConvexPolygon sole;
  add_foothold(state_.footholds[side], model_.feet[side].toe_point, sole);
  sole.make_hull();
  const Eigen::Vector3d inwards =
      heading() * Eigen::Vector3d(0.0, side_sign(state_.next_side), 0.0);
  double room = kReadyAcross * scale_.length;
  for (int i = 0; sole.size() >= 3 && i < sole.size(); ++i) {
    const Eigen::Vector2d edge = sole.vertex((i + 1) % sole.size()) - sole.vertex(i);
    const Eigen::Vector2d out = Eigen::Vector2d(edge.y(), -edge.x()).normalized();
    const double across = out.dot(inwards.head<2>());
    if (across > 0.5) room = std::min(room, out.dot(sole.vertex(i) - cmp) / across);
  }
  return std::max(room, 0.0) * (1.0 - 1.0 / growth);
}

// Waiting helps an ICP that has not come far enough towards the leading foot; one that runs ahead
// or has left the feet only gets away.
bool GaitMachine::icp_ready(const GaitdRobotState& robot, const GaitdIcpPlan& plan) const {
  if (support_polygon(model_, state_).inside_distance(sdk::view(robot.icp)) < kHeldMargin) {
    return true;
  }
  const Eigen::Quaterniond heading = this->heading();
  const Eigen::Vector2d error = sdk::view(robot.icp) - sdk::view(plan.icp);
  const Eigen::Vector3d local = heading.conjugate() * Eigen::Vector3d(error.x(), error.y(), 0.0);
  const GaitdPose& leading = state_.footholds[other_side(state_.next_side)].pose;
  const Eigen::Vector3d next = heading.conjugate() * (sdk::view(state_.adjusted[0].pose.position) -
                                                      sdk::view(leading.position));
  const double behind = next.x() < 0.0 ? local.x() : -local.x();
  const double inside = side_sign(state_.next_side) * local.y();
  return behind <= kReadyAlong * scale_.length && inside <= ready_across(plan);
}

// The ground loads a foot and stops it where it bears. A heel that brushes an edge, and the foot's
// own mass in a sensor above it, load the foot on its way, and for moments.
bool GaitMachine::has_landed(double dt, const GaitdFootState& foot) {
  const double weight = model_.total_mass * model_.gravity;
  const double least = parameters_[Gait::kTouchdownForce] * weight;
  landed_impulse_ = foot.normal_force > least ? landed_impulse_ + dt * foot.normal_force : 0.0;
  const double own =
      model_.bodies[model_.feet[state_.next_side].body].mass * kLandedStop * scale_.speed;
  if (landed_impulse_ < own) return false;
  Eigen::Vector3d velocity = sdk::view(foot.twist).tail<3>();
  if (foot.cop_valid != 0) {
    const Eigen::Vector3d arm(foot.cop[0], foot.cop[1], 0.0);
    velocity += Eigen::Vector3d(sdk::view(foot.twist).head<3>())
                    .cross(sdk::quaternion(foot.orientation) * arm);
  }
  // What bears more is believed sooner: after a hard landing the foot shakes for ten milliseconds.
  const double unit = scale_.speed * std::min(foot.normal_force / least, kLandedFirmly);
  return std::abs(velocity.z()) < kLandedRise * unit &&
         velocity.head<2>().norm() < kLandedSlide * unit;
}

void GaitMachine::adjust(const GaitdStepAdjustment& adjustment) {
  const bool swing = state_.phase == GAITD_PHASE_SWING;
  const Eigen::Vector3d shift = swing ? Eigen::Vector3d(sdk::view(adjustment.shift)) : shift_;
  if (shift == shift_ && adjustment.time_shift == time_shift_) return;
  shift_ = shift;
  state_.phase_duration += adjustment.time_shift - time_shift_;
  time_shift_ = adjustment.time_shift;
  changed();
  publish_footsteps();
}

void GaitMachine::feel_ground(double dt, const GaitdRobotState& robot) {
  const double weight = model_.total_mass * model_.gravity;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    GaitdFoothold& foothold = state_.footholds[side];
    // What carries a foot that leaves does not matter any more.
    const bool leaves = state_.phase == GAITD_PHASE_TRANSFER && state_.transfer_final == 0 &&
                        state_.next_side == side;
    if (leaves) continue;
    if (foothold.contact != GAITD_CONTACT_FULL || !rolls_foot(model_, side)) {
      contacts_[side].reset();
    } else if (contacts_[side].update(dt, robot.feet[side], weight, told_[side], foothold)) {
      changed();
    }
  }
}

void GaitMachine::update(double dt, const GaitdRobotState& robot, const GaitdIcpPlan& plan,
                         const GaitdToeOff& toe_off, const GaitdStepAdjustment& adjustment) {
  state_.time_in_phase += dt;
  if (drive_.wait(dt)) drive_on(begun(), GAITD_BOTH);
  const double end = state_.phase_duration - 0.5 * dt;
  const bool over = state_.time_in_phase >= end;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    GaitdFoothold& foothold = state_.footholds[side];
    if (foothold.contact == GAITD_CONTACT_NONE) continue;
    const bool may_roll = state_.phase != GAITD_PHASE_TRANSFER || side == state_.trailing_side ||
                          (state_.trailing_side == GAITD_BOTH && side == state_.next_side);
    const bool toe = toe_off.active != 0 && toe_off.side == side && may_roll;
    foothold.contact = toe ? GAITD_CONTACT_TOE : GAITD_CONTACT_FULL;
  }
  feel_ground(dt, robot);
  switch (state_.phase) {
    case GAITD_PHASE_STAND:
      apply_pending_mode();
      if (recover(dt, robot)) break;
      if (drive_.active() && queue_.size() == 0) rest_or_drive_on();
      if (queue_.size() > 0 && state_.paused == 0) begin_transfer(robot, GAITD_BOTH);
      break;
    case GAITD_PHASE_TRANSFER: {
      if (state_.transfer_final != 0) {
        if (recover(dt, robot)) break;
        if (queue_.size() > 0 && state_.paused == 0) {
          begin_transfer(robot, GAITD_BOTH);
        } else if (over && comes_back()) {
          begin_return(robot);
        } else if (over) {
          begin_stand();
        }
        break;
      }
      const bool ready = state_.time_remaining <= kReadyFor && icp_ready(robot, plan);
      ready_time_ = ready ? ready_time_ + dt : 0.0;
      if (adjustment.active != 0 && adjustment.time_shift != time_shift_) {
        adjust(adjustment);
      } else if (over && (ready_time_ > kReadyFor - 0.5 * dt ||
                          state_.time_in_phase >= end + kTransferPatience)) {
        begin_swing(robot);
      }
      break;
    }
    case GAITD_PHASE_SWING: {
      if (adjustment.active != 0) adjust(adjustment);
      const bool credible = state_.time_in_phase >= kTouchdownFraction * state_.phase_duration;
      const bool landed = has_landed(dt, robot.feet[state_.next_side]);
      state_.late_contact = over && !landed ? 1 : 0;
      if (landed && credible) touch_down(robot, !over);
      break;
    }
    default:
      break;
  }
  state_.time_remaining = std::max(0.0, state_.phase_duration - state_.time_in_phase);
}

void GaitMachine::publish_footsteps() {
  // Paused on the way: the plan ends after the step that has begun.
  const int visible =
      state_.paused != 0 && walking() ? std::max(own_steps_, 1) : GAITD_MAX_FOOTSTEPS;
  state_.footstep_count = std::min<int>(queue_.size(), visible);
  // The way goes on from where the last foot really landed and comes back to the commanded one.
  Eigen::Vector3d offset = state_.phase == GAITD_PHASE_SWING ? shift_ : path_offset_;
  for (int i = 0; i < state_.footstep_count; ++i) {
    state_.commanded[i] = queue_[i];
    state_.adjusted[i] = queue_[i];
    auto position = sdk::view(state_.adjusted[i].pose.position);
    position += offset;
    position.z() += height_offset_;
    if (i + 1 < state_.footstep_count) {
      offset = offset_of(i + 1, offset, state_.adjusted[i].pose);
    }
    if (2 * i + 1 < StepTiming::kPhases) {
      state_.adjusted[i].transfer_duration += time_changes_[2 * i];
      state_.adjusted[i].swing_duration += time_changes_[2 * i + 1];
    }
  }
}

}  // namespace gaitd::walking
