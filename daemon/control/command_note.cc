// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/command_note.h"

namespace gaitd::daemon {
namespace {

bool controlled(SafetyState state) {
  return state == SafetyState::kStanding || state == SafetyState::kWalking ||
         state == SafetyState::kStopping;
}

const char* arm_note(SafetyState state) {
  if (state == SafetyState::kDisarmed) return nullptr;
  return state == SafetyState::kReadying ? "nothing to do: readying already"
                                         : "nothing to do: armed already";
}

// stop and abort.
const char* end_note(SafetyState state, const GaitdGaitState& gait) {
  if (!controlled(state)) return "nothing to stop: the robot is not under control";
  if (gait.phase != GAITD_PHASE_STAND) return nullptr;
  if (gait.footstep_count > 0) return "standing: the footsteps ahead are dropped";
  return gait.paused != 0 ? "standing: only the pause ends" : "nothing to stop: standing";
}

const char* pause_note(const GaitdGaitState& gait) {
  if (gait.paused != 0) return "nothing to do: paused already";
  if (gait.phase != GAITD_PHASE_STAND) return nullptr;
  return "standing: footsteps that are sent now wait for `gaitctl resume`";
}

const char* resume_note(const GaitdGaitState& gait) {
  if (gait.paused == 0) return "nothing to resume: not paused";
  return gait.footstep_count == 0 ? "no footsteps wait: standing" : nullptr;
}

}  // namespace

const char* command_note(const Command& command, SafetyState state, const GaitdGaitState& gait) {
  switch (command.type) {
    case CommandType::kArm:
      return arm_note(state);
    case CommandType::kDisarm:
      return state == SafetyState::kDisarmed ? "nothing to do: disarmed already" : nullptr;
    case CommandType::kEstop:
      return state == SafetyState::kFault ? "a fault was latched already" : nullptr;
    case CommandType::kReset:
      return state == SafetyState::kFault ? nullptr : "nothing to reset: no fault is latched";
    case CommandType::kMode:
      if (gait.phase == GAITD_PHASE_STAND) {
        return command.mode == GAITD_MODE_STAND && gait.footstep_count > 0
                   ? "the footsteps that waited for `gaitctl resume` are dropped"
                   : nullptr;
      }
      return command.mode == GAITD_MODE_STAND ? "walking: it stops first"
                                              : "walking: from the next step on";
    case CommandType::kWalk:
    case CommandType::kFootsteps:
    case CommandType::kGoto:
      return gait.paused != 0 ? "paused: the footsteps wait for `gaitctl resume`" : nullptr;
    case CommandType::kPause:
      return pause_note(gait);
    case CommandType::kResume:
      return resume_note(gait);
    case CommandType::kStop:
    case CommandType::kAbort:
      return end_note(state, gait);
    default:
      return nullptr;
  }
}

}  // namespace gaitd::daemon
