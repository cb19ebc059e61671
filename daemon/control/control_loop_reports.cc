// SPDX-License-Identifier: Apache-2.0
// What the events of the log say of a tick.
#include <utility>

#include "daemon/control/command_text.h"
#include "daemon/control/control_loop.h"
#include "daemon/control/state_text.h"

namespace gaitd::daemon {

void ControlLoop::report_changes() {
  const TickData& d = pipeline_->data();
  char text[kMaxEventText];
  const JointMask dropped = d.dropped & ~std::exchange(last_dropped_, d.dropped);
  for (int i = 0; i < model_.joint_count && dropped >> i != 0; ++i) {
    if ((dropped >> i & 1u) == 0) continue;
    telemetry_->push_event(EventKind::kNote, d.time.tick, d.time.time,
                           dropped_text(pipeline_->monitor(), i, text, sizeof(text)));
  }
  report_recovery();
  report_feet();
  report_hands();
  report_surplus();
  if (d.payload.concluded) {
    telemetry_->push_event(
        EventKind::kNote, d.time.tick, d.time.time,
        payload_text(d.payload, model_.bodies[d.payload.found.body].name, text, sizeof(text)));
  }
  if (d.safety == last_state_ && d.faults == last_faults_) return;
  last_state_ = d.safety;
  last_faults_ = d.faults;
  telemetry_->push_event(d.safety == SafetyState::kFault ? EventKind::kFault : EventKind::kState,
                         d.time.tick, d.time.time, state_text(*pipeline_, text, sizeof(text)));
}

// The robot is not as heavy as it is known to be; told once as long as that lasts.
void ControlLoop::report_surplus() {
  const TickData& d = pipeline_->data();
  const bool misjudged = d.external.misjudged;
  if (std::exchange(misjudged_, misjudged) || !misjudged) return;
  char text[kMaxEventText];
  telemetry_->push_event(EventKind::kNote, d.time.tick, d.time.time,
                         surplus_text(d.external.surplus / model_.gravity, text, sizeof(text)));
}

// A robot that catches itself has left the place from which footsteps waited to be taken. While it
// is paused nothing else makes it step.
void ControlLoop::report_recovery() {
  const TickData& d = pipeline_->data();
  const bool stands = d.gait.phase == GAITD_PHASE_STAND;
  const bool wait = stands && d.gait.paused != 0 && d.gait.footstep_count > 0;
  if (!std::exchange(footsteps_wait_, wait) || stands || d.gait.paused == 0) return;
  char text[kMaxEventText];
  telemetry_->push_event(
      EventKind::kNote, d.time.tick, d.time.time,
      note_text("footsteps",
                "the robot caught itself; those that waited for `gaitctl resume` are dropped", text,
                sizeof(text)));
}

// A foothold turns out not to carry as a whole; told once of each.
void ControlLoop::report_feet() {
  const TickData& d = pipeline_->data();
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const bool partial = d.bearing[side] < 1.0;
    if (std::exchange(foot_partial_[side], partial) || !partial) continue;
    char text[kMaxEventText];
    telemetry_->push_event(EventKind::kNote, d.time.tick, d.time.time,
                           bearing_text(side, d.bearing[side], text, sizeof(text)));
  }
}

// A hand holds on or lets go; or a motion is over, and its hand is not where it should be.
void ControlLoop::report_hands() {
  constexpr double kFar = 0.01;     // m
  constexpr double kTurned = 0.03;  // rad
  const TickData& d = pipeline_->data();
  for (int hand = 0; hand < GAITD_MAX_HANDS; ++hand) {
    char text[kMaxEventText];
    if (d.handhold_changes[hand] != walking::Handholds::Change::kNone) {
      telemetry_->push_event(EventKind::kNote, d.time.tick, d.time.time,
                             handhold_text(hand, d.handhold_changes[hand], text, sizeof(text)));
    }
    const GaitdHandReference& reference = d.references.hands[hand];
    const bool moves = reference.active != 0 && reference.on_its_way != 0;
    const bool moved = std::exchange(hand_moved_[hand], moves);
    if (!moved || moves || reference.active == 0) continue;
    if (reference.position_error < kFar && reference.turn_error < kTurned) continue;
    telemetry_->push_event(EventKind::kNote, d.time.tick, d.time.time,
                           hand_text(hand, reference, text, sizeof(text)));
  }
}

}  // namespace gaitd::daemon
