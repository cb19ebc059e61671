// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "daemon/command/command.h"
#include "daemon/control/plan_port.h"
#include "gaitd/walking/gait_machine.h"

namespace gaitd::daemon {

// Puts the footsteps of walks, drives and clients on the ground as it is known: at the beginning of
// every transfer and every swing it asks for those that have not begun. [rt]
class RefineTask {
 public:
  explicit RefineTask(PlanPort* port) : port_(port) {}

  bool awaits_plan() const { return asked_; }
  // Once in a tick, in lockstep until it does not wait any more. `wanted`: somebody else than a
  // `goto`, which knows the ground, has made the footsteps. True: `out` is a command for the gait
  // machine.
  bool step(const walking::GaitMachine& gait, bool wanted, Command* out);

 private:
  void ask(const walking::GaitMachine& gait);

  PlanPort* port_;
  bool asked_ = false;
  std::uint64_t serial_ = 0;
  std::uint32_t step_ = 0;  // at which it was asked last
  std::int32_t phase_ = GAITD_PHASE_STAND;
};

}  // namespace gaitd::daemon
