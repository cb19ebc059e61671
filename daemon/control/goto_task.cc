// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/goto_task.h"

#include <algorithm>
#include <cstdio>

#include "daemon/control/plan_start.h"

namespace gaitd::daemon {
namespace {

constexpr int kMostAttempts = 5;  // to plan faster than the robot steps

}  // namespace

void GotoTask::begin(const Command& command, bool from_client, const walking::GaitMachine& gait) {
  drop();
  active_ = true;
  from_client_ = from_client;
  command_ = command;
  attempts_ = 0;
  sent_ = in_hand_ = 0;
  if (port_ != nullptr) ask(gait);
}

void GotoTask::drop() {
  release_plan();
  active_ = false;
}

void GotoTask::release_plan() {
  if (plan_ != nullptr && port_ != nullptr) port_->retire(plan_);
  plan_ = nullptr;
}

bool GotoTask::ask(const walking::GaitMachine& gait) {
  start_ = plan_start(gait);
  PlanRequest request;
  request.serial = ++serial_;
  request.start = start_;
  request.goal = {command_.target.x, command_.target.y, {}};
  if (command_.target.has_yaw) request.goal.yaw = command_.target.yaw;
  request.parameters = gait.parameters();
  return attempts_++ < kMostAttempts && port_->request(request);
}

GotoTask::Step GotoTask::refuse(const char* why) {
  std::snprintf(message_.data(), message_.size(), "%s", why);
  drop();
  return Step::kRefused;
}

void GotoTask::tell_done() {
  double time = 0.0;
  for (const GaitdFootstep& step : plan_->footsteps) {
    time += step.swing_duration + step.transfer_duration;
  }
  std::snprintf(message_.data(), message_.size(), "%d footsteps, about %.0f s",
                static_cast<int>(plan_->footsteps.size()), time);
}

GotoTask::Step GotoTask::step(const walking::GaitMachine& gait, Command* out) {
  if (port_ == nullptr) return active_ ? refuse("this gaitd has no planner") : Step::kWait;
  PlanAnswer answer;
  while (port_->next_answer(answer)) {
    if (active_ && answer.serial == serial_) {
      plan_ = answer.plan;
    } else {
      port_->retire(answer.plan);
    }
  }
  if (!active_ || plan_ == nullptr) return Step::kWait;
  if (!plan_->refusal.empty()) return refuse(plan_->refusal.c_str());
  if (sent_ == 0 && !still_fits(start_, plan_start(gait))) {
    release_plan();
    if (ask(gait)) return Step::kWait;
    return refuse("the robot steps on faster than footsteps are planned; `gaitctl stop` first");
  }
  const int count = static_cast<int>(plan_->footsteps.size());
  if (count == 0) {
    std::snprintf(message_.data(), message_.size(), "nothing to do: the robot stands there");
    drop();
    return Step::kDone;
  }
  if (sent_ == count) {
    tell_done();
    drop();
    return Step::kDone;
  }
  *out = Command{};
  out->type = CommandType::kFootsteps;
  out->replace = sent_ == 0;
  if (sent_ == 0 && is_chosen_only(gait)) {
    out->footsteps[out->footstep_count++] = gait.state().commanded[0];
  }
  in_hand_ = std::min(count - sent_, walking::kMaxFootstepsPerCommand - out->footstep_count);
  std::copy_n(plan_->footsteps.begin() + sent_, in_hand_,
              out->footsteps.begin() + out->footstep_count);
  out->footstep_count += in_hand_;
  return Step::kFootsteps;
}

void GotoTask::taken() { sent_ += in_hand_; }

}  // namespace gaitd::daemon
