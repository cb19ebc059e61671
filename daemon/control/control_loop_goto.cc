// SPDX-License-Identifier: Apache-2.0
// The part of the control loop that walks to a place: footsteps are planned on a thread of their
// own and taken as those of a client are.
#include <time.h>

#include <cmath>
#include <cstdio>

#include "daemon/control/command_text.h"
#include "daemon/control/control_loop.h"

namespace gaitd::daemon {
namespace {

constexpr const char* kReplaced = "another command has taken its place";
constexpr const char* kGivenUp = "goto: given up, another command has taken its place";

// What takes the place of footsteps that are being planned.
bool replaces_goto(const Command& command) {
  switch (command.type) {
    case CommandType::kArm:
    case CommandType::kPause:
    case CommandType::kResume:
    case CommandType::kSetParameter:
    case CommandType::kPush:
    case CommandType::kSwap:
    case CommandType::kJointTest:
    case CommandType::kPose:
    case CommandType::kTare:
    case CommandType::kPayload:
    case CommandType::kHandhold:
    case CommandType::kSimLoad:
    case CommandType::kRefine:
      return false;
    case CommandType::kMode:
      return command.mode == GAITD_MODE_STAND;
    case CommandType::kDrive:
      return !command.drive.ends;
    default:
      return true;
  }
}

void pause_for_plan() {
  const timespec pause{0, 200'000};
  nanosleep(&pause, nullptr);
}

}  // namespace

void ControlLoop::begin_goto(const Command& command, bool from_client) {
  const CommandReply reply = pipeline_->execute(command);
  if (!reply.accepted) return tell_goto(command, from_client, reply);
  give_up_goto(command);
  goto_.begin(command, from_client, pipeline_->gait());
}

void ControlLoop::give_up_goto(const Command& command) {
  if (!goto_.active() || !replaces_goto(command)) return;
  if (!goto_.answered()) {
    CommandReply reply;
    std::snprintf(reply.message.data(), reply.message.size(), "%s", kReplaced);
    tell_goto(goto_.command(), goto_.from_client(), reply);
  }
  if (command.type == CommandType::kGoto) return;  // which may be refused: settle() says
  if (goto_.answered() || goto_.replaces()) note_goto(kGivenUp);
  goto_.drop();
}

// To the log, and to the client if there is one.
void ControlLoop::tell_goto(const Command& command, bool from_client, CommandReply reply) {
  reply.request = command.request;
  reply.tick = tick_;
  char text[kMaxEventText];
  telemetry_->push_event(EventKind::kCommand, tick_, static_cast<double>(tick_) * options_.period,
                         command_text(command, reply, text, sizeof(text)));
  if (from_client) bridge_->push(reply);
}

// What was seen until now is there for the next plan. In lockstep simulated time stands still until
// the thread that looks at it has kept up.
void ControlLoop::take_sights() {
  const bool waits = options_.clock == GAITD_CLOCK_LOCKSTEP;
  while (!sight_.deliver(tick_) && waits && !stop_.load(std::memory_order_relaxed))
    pause_for_plan();
}

// In lockstep simulated time stands still while footsteps are planned, so that their tick is known.
void ControlLoop::take_plan() {
  const bool waits = options_.clock == GAITD_CLOCK_LOCKSTEP;
  if (goto_.answered() && !pipeline_->safety().controlled()) {
    note_goto("goto: given up, the robot is not under control");
    goto_.drop();
  }
  GotoTask::Step step = goto_.step(pipeline_->gait(), command_.get());
  while (waits && goto_.awaits_plan() && !stop_.load(std::memory_order_relaxed)) {
    pause_for_plan();
    step = goto_.step(pipeline_->gait(), command_.get());
  }
  if (step != GotoTask::Step::kFootsteps) show_goal();
  CommandReply reply;
  if (step == GotoTask::Step::kFootsteps) {
    if (const CommandReply taken = take_footsteps(*command_); taken.accepted) {
      goto_.taken();
    } else if (goto_.answered()) {
      note_goto(taken.message.data());
      goto_.refused(taken.message.data());
    } else {
      std::snprintf(reply.message.data(), reply.message.size(), "%s", taken.message.data());
      answer_goto(reply);
    }
  } else if (step == GotoTask::Step::kEnded) {
    note_goto(goto_.message());
  } else if (step != GotoTask::Step::kWait) {
    reply.accepted = step == GotoTask::Step::kDone;
    const GaitdGaitState& gait = pipeline_->gait().state();
    const bool waits = reply.accepted && gait.paused != 0 && gait.footstep_count > 0;
    std::snprintf(reply.message.data(), reply.message.size(), "%s%s", goto_.message(),
                  waits ? "; paused: the footsteps wait for `gaitctl resume`" : "");
    answer_goto(reply);
  }
}

// After this it is the one that leads on, or the one before it is: who gets the answer finds that
// in the status.
void ControlLoop::answer_goto(const CommandReply& reply) {
  *command_ = goto_.command();
  const bool from_client = goto_.from_client();
  const bool given_up = goto_.settle(reply.accepted);
  show_goal();
  tell_goto(*command_, from_client, reply);
  if (given_up) note_goto(kGivenUp);
}

void ControlLoop::show_goal() {
  const auto& target = goto_.command().target;
  goal_.store(goto_.active() ? Place{static_cast<float>(target.x), static_cast<float>(target.y)}
                             : Place{NAN, NAN},
              std::memory_order_relaxed);
}

std::optional<ControlLoop::Place> ControlLoop::goal() const noexcept {
  static_assert(std::atomic<Place>::is_always_lock_free);
  const Place goal = goal_.load(std::memory_order_relaxed);
  return std::isnan(goal.x) ? std::nullopt : std::optional(goal);
}

// Footsteps of others, put on the ground as it is known.
void ControlLoop::take_refinement() {
  const bool waits = options_.clock == GAITD_CLOCK_LOCKSTEP;
  const bool wanted = !goto_.active() && pipeline_->safety().controlled();
  bool comes = refine_.step(pipeline_->gait(), wanted, command_.get());
  while (waits && refine_.awaits_plan() && !stop_.load(std::memory_order_relaxed)) {
    pause_for_plan();
    comes = refine_.step(pipeline_->gait(), wanted, command_.get());
  }
  if (comes) take_footsteps(*command_);
}

// To the log: what becomes of a goto after it was answered.
void ControlLoop::note_goto(const char* text) {
  char note[kMaxEventText];
  telemetry_->push_event(EventKind::kNote, tick_, static_cast<double>(tick_) * options_.period,
                         note_text("goto", text, note, sizeof(note)));
}

// They are what a replay needs to know.
CommandReply ControlLoop::take_footsteps(const Command& command) {
  const CommandReply reply = pipeline_->execute(command);
  const double time = static_cast<double>(tick_) * options_.period;
  if (reply.accepted) {
    char text[kMaxEventText];
    telemetry_->push_event(EventKind::kCommand, tick_, time,
                           command_text(command, reply, text, sizeof(text)));
  }
  telemetry_->push_input(tick_, time, command, -1, -1);
  return reply;
}

}  // namespace gaitd::daemon
