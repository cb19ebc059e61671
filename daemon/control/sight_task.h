// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "daemon/control/plan_port.h"
#include "daemon/control/tick_data.h"

namespace gaitd::daemon {

// How often the ground is looked at, in ticks. period 0: never.
struct SightTiming {
  std::int64_t period = 0;
  std::int64_t latency = 0;  // until what was seen is known, at most 15 periods
};

// Takes down where the robot is for the thread that knows the ground; of a simulated sensor as
// often as it looks, and handed over as late as it takes. [rt]
class SightTask {
 public:
  SightTask(PlanPort* port, const SightTiming& timing) : port_(port), timing_(timing) {}

  // The simulation begins anew: what is not seen yet was before that.
  void restart() { anew_ = true; }
  // After a tick.
  void look(const GaitdModel& model, const TickData& data, std::int64_t tick);
  // Before a tick. False: the other thread has not kept up; in lockstep the tick waits.
  bool deliver(std::int64_t tick);

 private:
  static constexpr std::int64_t kPending = 16;
  PlanPort* port_;
  const SightTiming timing_;
  struct Pending {
    Sight sight;
    std::int64_t due = 0;  // tick
  };
  std::array<Pending, kPending> pending_;
  std::int64_t looked_ = 0, delivered_ = 0;
  bool anew_ = false;
};

}  // namespace gaitd::daemon
