// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace gaitd::daemon {

// How a run of the control loop ended. The word stands in the log as the metadata `end`.
enum class RunEnd {
  kStopped = 0,  // somebody asked for it
  kSettled,      // the scenario was played and the robot stands
  kDuration,     // the time of the scenario was over
  kFault,        // of the scenario: a fault that latched
  kBackend,      // the backend failed
  kPush,         // a push of the scenario could not be made
  kHung          // a plugin did not return
};
inline constexpr std::array<const char*, 7> kRunEndNames = {
    "stopped", "settled", "duration", "fault", "backend", "push", "hung"};

}  // namespace gaitd::daemon
