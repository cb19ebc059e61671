// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/goto_task.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "daemon/control/plan_start.h"
#include "gaitd/walking/footsteps.h"

namespace gaitd::daemon {
namespace {

constexpr int kMostAttempts = 5;   // to plan faster than the robot steps
constexpr int kMostTries = 4;      // standing, to find a way on
constexpr double kTryAgain = 0.5;  // s, between them
constexpr double kNotThere = 0.2;  // m, of the middle of the feet from the goal
constexpr double kBetter = 0.5;    // steps, of the cost of a plan that leads nearer
constexpr int kMostStale = 30;     // plans
// What was seen on the way may make it longer, by so much more than steps cost by chance; but not
// for ever.
constexpr double kSetback = 1.15;
constexpr int kMostSetbacks = 20;

}  // namespace

void GotoTask::begin(const Command& command, bool from_client, const walking::GaitMachine& gait) {
  if (under_way_) before_ = walk_;
  close();
  active_ = true;
  from_client_ = from_client;
  walk_.command = command;
  attempts_ = 0;
  walk_.partial = false;
  walk_.tries = 0;
  if (port_ != nullptr) ask(gait, PlanKind::kGoto);
}

bool GotoTask::settle(bool accepted) {
  if (!accepted) close();
  if (!before_) return false;
  const bool goes_on = !accepted && commands_ == 0;
  if (goes_on) {
    walk_ = *before_;
    active_ = under_way_ = true;
  }
  before_.reset();
  return !goes_on;
}

void GotoTask::drop() {
  close();
  before_.reset();
}

void GotoTask::close() {
  release_plan();
  active_ = asked_ = under_way_ = false;
}

void GotoTask::release_plan() {
  if (plan_ != nullptr && port_ != nullptr) port_->retire(plan_);
  plan_ = nullptr;
}

void GotoTask::ask(const walking::GaitMachine& gait, PlanKind kind) {
  release_plan();
  sent_ = in_hand_ = commands_ = 0;
  kind_ = kind;
  start_ = plan_start(gait);
  PlanRequest request;
  request.serial = ++serial_;
  request.kind = kind;
  request.taken = taken_;
  request.start = start_;
  request.goal = {walk_.command.target.x, walk_.command.target.y, {}};
  if (walk_.command.target.has_yaw) request.goal.yaw = walk_.command.target.yaw;
  request.height_offset = gait.height_offset();
  request.parameters = gait.parameters();
  asked_ = port_->request(request);
}

GotoTask::Step GotoTask::ask_again(const walking::GaitMachine& gait) {
  if (++attempts_ < kMostAttempts) {
    ask(gait, kind_);
    if (asked_) return Step::kWait;
  }
  if (!under_way_) {
    return end(Step::kRefused,
               "the robot steps on faster than footsteps are planned; `gaitctl stop` first");
  }
  release_plan();  // what is ahead stays; the next step asks again
  asked_ = false;
  return Step::kWait;
}

GotoTask::Step GotoTask::end(Step how, const char* why) {
  std::snprintf(message_.data(), message_.size(), "%s", why);
  close();
  return how;
}

// m, of the middle of the feet.
double GotoTask::off_goal(const walking::GaitMachine& gait) const {
  const GaitdFoothold* feet = gait.state().footholds;
  const GaitdPose middle = walking::middle_pose(feet[GAITD_LEFT].pose, feet[GAITD_RIGHT].pose);
  return std::hypot(middle.position[0] - walk_.command.target.x,
                    middle.position[1] - walk_.command.target.y);
}

GotoTask::Step GotoTask::give_up(const walking::GaitMachine& gait, const char* why) {
  char text[256];
  std::snprintf(text, sizeof(text), "goto: given up, %.2f m off: %.200s", off_goal(gait), why);
  return end(Step::kEnded, text);
}

void GotoTask::tell_done() {
  double time = 0.0;
  for (const GaitdFootstep& step : plan_->footsteps) {
    time += step.swing_duration + step.transfer_duration;
  }
  std::snprintf(message_.data(), message_.size(), "%d footsteps, about %.0f s%s",
                static_cast<int>(plan_->footsteps.size()), time,
                plan_->partial ? ", to where the ground is not known yet" : "");
}

void GotoTask::take_answers() {
  PlanAnswer answer;
  while (port_->next_answer(answer)) {
    if (active_ && asked_ && answer.serial == serial_ && plan_ == nullptr) {
      plan_ = answer.plan;
      unchanged_ = answer.unchanged;
    } else {
      port_->retire(answer.plan);
    }
  }
}

GotoTask::Step GotoTask::step(const walking::GaitMachine& gait, Command* out) {
  if (port_ == nullptr) {
    return active_ ? end(Step::kRefused, "this gaitd has no planner") : Step::kWait;
  }
  take_answers();
  if (!active_) return Step::kWait;
  if (!asked_) return under_way_ ? watch(gait) : end(Step::kRefused, "too many plans at once");
  return plan_ == nullptr ? Step::kWait : hand_over(gait, out);
}

// On a map that grows, while the footsteps are taken.
GotoTask::Step GotoTask::watch(const walking::GaitMachine& gait) {
  const GaitdGaitState& state = gait.state();
  if (state.phase == GAITD_PHASE_SWING && state.footstep_count > 0 &&
      state.commanded[0].id != walk_.step) {
    walk_.step = state.commanded[0].id;
    attempts_ = walk_.tries = 0;
    ask(gait, PlanKind::kRevise);
    return Step::kWait;
  }
  if (state.phase != GAITD_PHASE_STAND || state.footstep_count > 0) return Step::kWait;
  const double off = off_goal(gait);
  if (!walk_.partial && off < kNotThere) {
    std::snprintf(walk_.why.data(), walk_.why.size(), "goto: arrived, %.3f m off", off);
    return end(Step::kEnded, walk_.why.data());
  }
  if (state.time_in_phase < kTryAgain * (walk_.tries + 1)) return Step::kWait;
  if (++walk_.tries > kMostTries) {
    return give_up(gait, walk_.why.data());
  }
  attempts_ = 0;
  ask(gait, PlanKind::kRevise);
  return Step::kWait;
}

GotoTask::Step GotoTask::hand_over(const walking::GaitMachine& gait, Command* out) {
  if (unchanged_) return all_taken();
  const int count = static_cast<int>(plan_->footsteps.size());
  const bool refused = !plan_->refusal.empty();
  if (refused && !under_way_) return end(Step::kRefused, plan_->refusal.c_str());
  if (commands_ == 0 && !still_fits(start_, plan_start(gait))) return ask_again(gait);
  if (commands_ == 0 && under_way_ && gets_nowhere()) {
    return give_up(gait, "the way changes at every step and leads no nearer to the goal");
  }
  if (count == 0 && !refused && !under_way_) {
    return end(Step::kDone, "nothing to do: the robot stands there");
  }
  const bool nothing_ahead = count == 0 && (!refused || gait.state().footstep_count == 0);
  if (nothing_ahead || (commands_ > 0 && sent_ == count)) return all_taken();
  *out = Command{};
  out->type = CommandType::kFootsteps;
  out->replace = commands_ == 0;
  out->routed = true;
  if (commands_ == 0 && is_chosen_only(gait)) {
    out->footsteps[out->footstep_count++] = gait.state().commanded[0];
  }
  in_hand_ = std::min(count - sent_, walking::kMaxFootstepsPerCommand - out->footstep_count);
  std::copy_n(plan_->footsteps.begin() + sent_, in_hand_,
              out->footsteps.begin() + out->footstep_count);
  out->footstep_count += in_hand_;
  return Step::kFootsteps;
}

// Whether the plans of many steps were no better than one before: it goes back and forth.
bool GotoTask::gets_nowhere() {
  const bool found = plan_->refusal.empty();
  if (found && plan_->cost > kSetback * walk_.last_cost && ++walk_.setbacks <= kMostSetbacks) {
    walk_.least_cost = plan_->cost + 2.0 * kBetter;
  }
  if (found) walk_.last_cost = plan_->cost;
  const bool better = found && plan_->cost < walk_.least_cost - kBetter;
  if (better) walk_.least_cost = plan_->cost;
  walk_.stale = better ? 0 : walk_.stale + 1;
  return walk_.stale > kMostStale;
}

// The plan is with the gait machine.
GotoTask::Step GotoTask::all_taken() {
  const bool first = !under_way_;
  if (!unchanged_) taken_ = serial_;
  if (!unchanged_) walk_.partial = plan_->partial || !plan_->refusal.empty();
  if (walk_.partial) {
    std::snprintf(walk_.why.data(), walk_.why.size(), "%s",
                  plan_->refusal.empty() ? "the ground beyond is not seen from here"
                                         : plan_->refusal.c_str());
  }
  if (first) {
    tell_done();
    walk_.least_cost = walk_.last_cost = plan_->cost;
    walk_.stale = walk_.setbacks = 0;
  }
  if (!port_->live()) {
    close();
    return Step::kDone;
  }
  release_plan();
  asked_ = false;
  under_way_ = true;
  return first ? Step::kDone : Step::kWait;
}

void GotoTask::taken() {
  ++commands_;
  sent_ += in_hand_;
}

void GotoTask::refused(const char* why) {
  std::snprintf(walk_.why.data(), walk_.why.size(), "%s", why);
  walk_.partial = true;
  release_plan();
  asked_ = false;
}

}  // namespace gaitd::daemon
