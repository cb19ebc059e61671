// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "daemon/app/hang_guard.h"
#include "daemon/app/service_manager.h"
#include "daemon/control/control_loop.h"
#include "daemon/control/tick_watch.h"
#include "daemon/telemetry/telemetry.h"

namespace gaitd::daemon {

// Says on the terminal, and to systemd, what the control thread must not stop to say: faults, when
// they come and go, ticks that were late, where the log goes on or why it ended, and that a plugin
// does not return.
class Watch {
 public:
  // All of it outlives the watch.
  struct Sources {
    const Telemetry& telemetry;
    const TickWatch& ticks;
    const ControlLoop& loop;
    const std::atomic<bool>& stop_requested;
    bool lockstep;
    // What runs in a layer, for people.
    std::function<std::string(int layer)> plugin;
    // Ends the process without its control loop; does not return.
    std::function<void()> give_up;
  };
  Watch(Sources sources, ServiceManager* manager);

  // Looks around twenty times a second while `running`.
  void run(const std::atomic<bool>& running);

 private:
  void tell_overruns();
  void tell_of_log();
  void tell_of_faults();
  void look_for_hang();

  const Sources from_;
  ServiceManager* manager_;
  HangGuard guard_;
  const int faults_signal_;
  const int state_signal_;
  std::vector<double> values_;
  std::uint32_t faults_ = 0;
  Telemetry::LogStatus log_;
  std::uint64_t overruns_told_ = 0;
  std::chrono::steady_clock::time_point next_told_;
};

}  // namespace gaitd::daemon
