// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

#include "daemon/app/realtime.h"
#include "daemon/command/estop_flag.h"
#include "daemon/control/control_loop.h"
#include "daemon/control/tick_watch.h"
#include "daemon/swap/swap_service.h"
#include "daemon/telemetry/telemetry.h"
#include "gaitd/abi/plugin.h"
#include "gaitd/abi/types.h"

namespace gaitd::daemon {

// What gaitd says of itself and of its robot: the snapshots that `status` and `joint.list` answer
// with. Waits for no tick. Any thread.
class StatusReport {
 public:
  // All of it outlives the report.
  struct Sources {
    const GaitdModel* model;
    GaitdBackendInstance backend;
    const Telemetry* telemetry;
    const TickWatch* watch;
    const SwapService* swaps;
    const EstopFlag* estop;
    bool lockstep;
    // What does not change: robot, backend, clock, version, scenario.
    nlohmann::json constants;
  };
  explicit StatusReport(Sources sources) : sources_(std::move(sources)) {}

  // What there is of real time, so far.
  void set_realtime(const RealtimeReport& realtime);
  // Of the control loop, once there is one.
  void set_loop(const ControlLoop* loop) { loop_ = loop; }

  nlohmann::json status() const;
  // Every joint as its sensors show it, for checks of signs and offsets.
  nlohmann::json joints() const;

 private:
  nlohmann::json health() const;
  nlohmann::json log() const;
  void add_age(nlohmann::json* status) const;

  const Sources sources_;
  std::atomic<const ControlLoop*> loop_{nullptr};
  mutable std::mutex realtime_mutex_;
  RealtimeReport realtime_;
};

// Lets the fault of a stop that was asked for show before the tick that takes it is over, which may
// be late: no status says less than an answer that was given before it. The state follows as soon
// as the control thread has taken the stop.
void show_estop(const EstopFlag& estop, nlohmann::json* status);

}  // namespace gaitd::daemon
