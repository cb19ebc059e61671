// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/refine_task.h"

#include <algorithm>

#include "daemon/control/plan_start.h"

namespace gaitd::daemon {

void RefineTask::ask(const walking::GaitMachine& gait) {
  const GaitdGaitState& state = gait.state();
  PlanRequest request;
  request.serial = ++serial_;
  request.kind = PlanKind::kRefine;
  // In a transfer the next footstep has been chosen, but may still be put elsewhere.
  const bool swings = state.phase == GAITD_PHASE_SWING;
  request.start = swings ? plan_start(gait) : standing_start(gait);
  const int first = swings ? 1 : 0;
  request.ahead_count = state.footstep_count - first;
  std::copy_n(state.commanded + first, request.ahead_count, request.ahead.begin());
  request.height_offset = gait.height_offset();
  request.parameters = gait.parameters();
  asked_ = request.ahead_count > 0 && port_->request(request);
}

bool RefineTask::step(const walking::GaitMachine& gait, bool wanted, Command* out) {
  if (port_ == nullptr) return false;
  const footsteps::Plan* plan = nullptr;
  PlanAnswer answer;
  while (port_->next_answer(answer)) {
    if (plan != nullptr) port_->retire(plan);
    plan = answer.plan;
    if (answer.serial == serial_) asked_ = false;
  }
  if (plan != nullptr) {
    const int count = static_cast<int>(plan->footsteps.size());
    if (wanted && count > 0) {
      *out = Command{};
      out->type = CommandType::kRefine;
      out->footstep_count = std::min(count, walking::kMaxFootstepsPerCommand);
      std::copy_n(plan->footsteps.begin(), out->footstep_count, out->footsteps.begin());
    }
    port_->retire(plan);
    return wanted && count > 0;
  }
  const GaitdGaitState& state = gait.state();
  const bool steps = state.footstep_count > 0 && state.phase != GAITD_PHASE_STAND &&
                     (state.phase == GAITD_PHASE_SWING || state.transfer_final == 0);
  if (!steps || !wanted || !port_->live() || asked_) return false;
  const std::uint32_t step = state.commanded[0].id;
  if (step_ == step && phase_ == state.phase) return false;
  step_ = step;
  phase_ = state.phase;
  ask(gait);
  return false;
}

}  // namespace gaitd::daemon
