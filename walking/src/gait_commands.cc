// SPDX-License-Identifier: Apache-2.0
// The commands of the gait machine: what operators and scenarios may ask of it.
#include <algorithm>
#include <array>
#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/gait_machine.h"
#include "gaitd/walking/support.h"

namespace gaitd::walking {
namespace {

// Of a walk: the first two are taken from where the feet stand, then one for each foot, and one
// more for walks that end with the other foot.
constexpr int kDistinctSteps = 5;

constexpr int kMostReturning = 10;  // steps: who is pushed all the time does not step for ever
}  // namespace

Refusal GaitMachine::check_room(int count) const {
  if (count <= queue_.free()) return {};
  return refuse("%d footsteps: the queue has room for %d of %d; send fewer, or wait", count,
                queue_.free(), kQueueCapacity);
}

void GaitMachine::fill_in(GaitdFootstep& step) const {
  if (step.swing_duration == 0.0) step.swing_duration = parameters_[Gait::kSwingDuration];
  if (step.transfer_duration == 0.0) step.transfer_duration = parameters_[Gait::kTransferDuration];
  if (step.swing_height == 0.0) step.swing_height = parameters_[Gait::kSwingHeight];
}

void GaitMachine::complete(GaitdFootstep& step) {
  fill_in(step);
  step.id = next_id_++;
}

Refusal GaitMachine::check(const GaitdFootstep& step, const GaitdPose& stance,
                           const GaitdPose& from, int number) const {
  GaitdFootstep filled = step;
  fill_in(filled);
  return step_check_.check(filled, stance, from, number, parameters_);
}

Refusal GaitMachine::check_capture(const GaitdFootstep* steps, int count, int kept,
                                   int closing_number, int before) const {
  const auto at = [&](int i) -> const GaitdFootstep& {
    return i < kept ? queue_[i] : steps[i - kept];
  };
  // A foot that lands, and what follows it.
  std::array<GaitdFootstep, CaptureCheck::kAhead> ahead;
  for (int landing = std::max(kept - 1, 0); landing + 1 < kept + count; ++landing) {
    const int known = std::min(CaptureCheck::kAhead, kept + count - landing);
    for (int i = 0; i < known; ++i) {
      ahead[i] = at(landing + i);
      fill_in(ahead[i]);
    }
    GaitdFoothold stance = landing > 0 ? bearing_of(model_, at(landing - 1))
                                       : state_.footholds[other_side(ahead[0].side)];
    stance.contact = GAITD_CONTACT_FULL;
    const int number = ahead[1].closing != 0 ? closing_number : landing + 2 - kept + before;
    if (Refusal r =
            capture_check_.check(stance, ahead.data(), known, kFinalTransfer, state_.omega, number);
        r.refused()) {
      return r;
    }
  }
  return {};
}

Refusal GaitMachine::set_mode(int mode) {
  if (mode < GAITD_MODE_STAND || mode > GAITD_MODE_WALK_BENT) {
    return refuse("mode %d: stand, walk-straight or walk-bent expected", mode);
  }
  if (mode == GAITD_MODE_STAND && (walking() || queue_.size() > 0 || drive_.active())) stop();
  pending_mode_ = mode;
  return {};
}

Refusal GaitMachine::walk(const WalkCommand& walk) {
  if (pending_mode_ == GAITD_MODE_STAND) {
    return refuse("walk: the gait mode is stand; choose one to walk in: gaitctl mode walk-bent");
  }
  if (walk.steps < 1) return refuse("walk: at least 1 step expected, got %d", walk.steps);
  const int kept = left_by_another();
  if (Refusal r = check_room(walk.steps + 1 - (queue_.size() - kept)); r.refused()) return r;
  // The feet from which the first new footstep is taken: the last two places on the way.
  GaitdPose feet[2] = {state_.footholds[GAITD_LEFT].pose, state_.footholds[GAITD_RIGHT].pose};
  for (int side = 0; side < 2; ++side) {
    feet[side].position[2] -= height_offset_;
    // On the commanded way, also where a push has moved a foot off it.
    if (kept > 0 && goals_[side].stood_on) feet[side] = goals_[side].step.pose;
  }
  for (int i = 0; i < kept; ++i) feet[queue_[i].side] = queue_[i].pose;
  int first = walk.first_side;
  if (kept > 0) {
    const int next = other_side(queue_[kept - 1].side);
    if (first != GAITD_BOTH && first != next) {
      return refuse("walk: the last footstep ahead is %s, so the first must be %s",
                    side_name(other_side(next)), side_name(next));
    }
    first = next;
  } else if (first == GAITD_BOTH) {
    // Into the walk with the foot on the side it goes to, so that the legs never close first.
    first =
        walk.lateral > 0.0 || (walk.lateral == 0.0 && walk.turn > 0.0) ? GAITD_LEFT : GAITD_RIGHT;
  }
  const double width = walk.width > 0.0 ? walk.width : model_.nominal_foot_separation;
  const double least = limits().least_separation;
  if (width < least) {
    return refuse("walk: width %.3f m, at least %.3f expected, or the legs cross", width, least);
  }
  GaitdPose middle = middle_pose(feet[GAITD_LEFT], feet[GAITD_RIGHT]);
  middle.position[2] = first_level(feet, first);
  // From the third on each footstep is to the two before it as the one two further on: a long walk
  // is as good as a short one that ends with the same foot, and costs a tick no more.
  WalkCommand shorter = walk;
  if (walk.steps > kDistinctSteps) {
    shorter.steps = kDistinctSteps - (walk.steps - kDistinctSteps) % 2;
  }
  FootstepGenerator trial(shorter, middle, first, width, least);
  GaitdPose at[2] = {feet[GAITD_LEFT], feet[GAITD_RIGHT]};
  std::array<GaitdFootstep, kDistinctSteps + 1> distinct;
  for (int i = 0; i < trial.count(); ++i) {
    const GaitdFootstep step = distinct[i] = trial.next();
    const int number = step.closing != 0 ? walk.steps + 1 : i + 1;
    if (Refusal r = check(step, at[other_side(step.side)], at[step.side], number); r.refused()) {
      return r;
    }
    at[step.side] = step.pose;
  }
  if (Refusal r = check_capture(distinct.data(), trial.count(), kept, walk.steps + 1);
      r.refused()) {
    return r;
  }
  keep_first(kept);
  returns_left_ = kMostReturning;
  drive_.end();
  routed_ = false;
  FootstepGenerator generator(walk, middle, first, width, least);
  for (int i = 0; i < generator.count(); ++i) {
    GaitdFootstep step = generator.next();
    complete(step);
    queue_.push(step);
  }
  publish_footsteps();
  changed();
  return {};
}

Refusal GaitMachine::footsteps(const GaitdFootstep* steps, int count, bool replace, bool routed) {
  if (pending_mode_ == GAITD_MODE_STAND) {
    return refuse("steps: the gait mode is stand; choose one to walk in: gaitctl mode walk-bent");
  }
  // A transfer has chosen its foot: its footstep may be replaced by one of the same side only.
  const bool committed = state_.phase == GAITD_PHASE_TRANSFER && state_.transfer_final == 0;
  int kept = routed ? queue_.size() : left_by_another();
  if (replace) kept = recovering() ? begun() : std::min(first_free(), queue_.size());
  // The footstep that the transfer has chosen, sent again: it stays, with how it was moved.
  const bool again = replace && committed && count > 0 && queue_.size() > 0 && steps[0].id != 0 &&
                     steps[0].id == queue_[0].id;
  if (again) {
    kept = 1;
    ++steps;
    --count;
  }
  const int before = again ? 1 : 0;  // of those that were sent
  if (count < 1 && !again && !(replace && !committed)) {
    return refuse("steps: at least one expected, got none");
  }
  if (Refusal r = check_room(count - (queue_.size() - kept)); r.refused()) return r;
  GaitdPose feet[2] = {state_.footholds[GAITD_LEFT].pose, state_.footholds[GAITD_RIGHT].pose};
  for (int side = 0; side < 2; ++side) feet[side].position[2] -= height_offset_;
  for (int i = 0; i < kept; ++i) feet[queue_[i].side] = queue_[i].pose;
  int expected = kept > 0 ? other_side(queue_[kept - 1].side) : GAITD_BOTH;
  if (kept == 0 && committed) expected = state_.next_side;
  for (int i = 0; i < count; ++i) {
    const GaitdFootstep& step = steps[i];
    const int number = before + i + 1;
    if (step.side != GAITD_LEFT && step.side != GAITD_RIGHT) {
      return refuse("footstep %d: side left or right expected", number);
    }
    if (expected != GAITD_BOTH && step.side != expected) {
      return refuse("footstep %d: side %s expected, because feet alternate%s, got %s", number,
                    side_name(expected), i == 0 ? " with the footsteps already ahead" : "",
                    side_name(step.side));
    }
    if (Refusal r = check(step, feet[other_side(step.side)], feet[step.side], number);
        r.refused()) {
      return r;
    }
    feet[step.side] = step.pose;
    expected = other_side(step.side);
  }
  if (Refusal r = check_capture(steps, count, kept, before + count, before); r.refused()) return r;
  keep_first(kept);
  returns_left_ = kMostReturning;
  drive_.end();
  routed_ = routed;
  for (int i = 0; i < count; ++i) {
    GaitdFootstep step = steps[i];
    complete(step);
    queue_.push(step);
  }
  publish_footsteps();
  changed();
  return {};
}

Refusal GaitMachine::refine(const GaitdFootstep* steps, int count) {
  std::array<GaitdFootstep, GAITD_MAX_FOOTSTEPS> ahead;
  const int known = std::min<int>(queue_.size(), GAITD_MAX_FOOTSTEPS);
  const int kept = std::min(first_free(), known);
  for (int i = 0; i < known; ++i) ahead[i] = queue_[i];
  for (int i = 0; i < count; ++i) {
    const auto old = std::find_if(ahead.begin() + kept, ahead.begin() + known,
                                  [&](const auto& s) { return s.id == steps[i].id; });
    if (old == ahead.begin() + known) continue;
    GaitdFootstep step = steps[i];
    step.side = old->side;
    step.closing = old->closing;
    *old = step;
  }
  GaitdPose feet[2] = {state_.footholds[GAITD_LEFT].pose, state_.footholds[GAITD_RIGHT].pose};
  for (GaitdPose& foot : feet) foot.position[2] -= height_offset_;
  for (int i = 0; i < known; ++i) {
    const GaitdFootstep& step = ahead[i];
    if (i >= kept) {
      const GaitdPose& stance = feet[other_side(step.side)];
      if (Refusal r = check(step, stance, feet[step.side], i + 1); r.refused()) return r;
    }
    feet[step.side] = step.pose;
  }
  if (Refusal r = check_capture(ahead.data() + kept, known - kept, kept, known); r.refused()) {
    return r;
  }
  for (int i = kept; i < known; ++i) queue_[i] = ahead[i];
  publish_footsteps();
  changed();
  return {};
}

Refusal GaitMachine::pause() {
  drive_.end();
  state_.paused = 1;
  publish_footsteps();
  changed();
  return {};
}

Refusal GaitMachine::resume() {
  state_.paused = 0;
  publish_footsteps();
  changed();
  return {};
}

GaitdFootstep GaitMachine::closing_step(const GaitdPose& stance, int side) const {
  GaitdFootstep step{};
  step.side = side;
  step.closing = 1;
  GaitdPose plane = stance;
  if (!on_slope(stance, state_.footholds[side].pose)) {
    sdk::store(sdk::from_yaw(sdk::yaw_of(sdk::quaternion(stance.orientation))), plane.orientation);
  }
  step.pose = plane;
  sdk::view(step.pose.position) =
      sdk::transform(plane, {0.0, side_sign(side) * model_.nominal_foot_separation, 0.0});
  return step;
}

Refusal GaitMachine::stop() {
  drive_.end();
  routed_ = false;
  returns_left_ = 0;
  state_.paused = 0;
  if (recovering()) {  // it catches itself and closes its feet: that is how it comes to a stand
    keep_first(own_steps_);
    publish_footsteps();
    changed();
    return {};
  }
  const int kept = std::min(first_free(), queue_.size());
  GaitdPose stance;
  int side;
  if (kept > 0) {  // finish the swing, then close beside it
    stance = queue_[0].pose;
    side = other_side(queue_[0].side);
  } else if (state_.phase == GAITD_PHASE_TRANSFER && state_.transfer_final == 0) {
    side = state_.next_side;
    stance = state_.footholds[other_side(side)].pose;
    stance.position[2] -= height_offset_;
  } else {
    keep_first(0);
    publish_footsteps();
    changed();
    return {};
  }
  // Of the step that the closing foot was to take: what it passes over is still there.
  const GaitdFootstep passed = queue_[std::min(kept, queue_.size() - 1)];
  keep_first(kept);
  GaitdFootstep step = closing_step(stance, side);
  GaitdPose standing = state_.footholds[side].pose;
  standing.position[2] -= height_offset_;
  const double gap = (sdk::view(standing.position) - sdk::view(step.pose.position)).norm();
  if (kept > 0 && gap < kNoClosingStep) {
    publish_footsteps();
    changed();
    return {};
  }
  step.swing_duration = passed.swing_duration;
  step.transfer_duration = passed.transfer_duration;
  step.swing_height = passed.swing_height;
  complete(step);
  queue_.push(step);
  publish_footsteps();
  changed();
  return {};
}

int GaitMachine::begun() const {
  const bool chosen = state_.phase == GAITD_PHASE_TRANSFER && state_.transfer_final == 0;
  return std::min(state_.phase == GAITD_PHASE_SWING || chosen ? 1 : 0, queue_.size());
}

Refusal GaitMachine::abort() {
  drive_.end();
  routed_ = false;
  returns_left_ = 0;
  state_.paused = 0;
  keep_first(begun());
  publish_footsteps();
  changed();
  return {};
}

}  // namespace gaitd::walking
