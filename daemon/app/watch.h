// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <vector>

#include "daemon/app/service_manager.h"
#include "daemon/control/tick_watch.h"
#include "daemon/telemetry/telemetry.h"

namespace gaitd::daemon {

// Says on the terminal, and to systemd, what the control thread must not stop to say: faults, when
// they come and go, ticks that were late, and where the log goes on or why it ended.
class Watch {
 public:
  // All of it outlives the watch.
  Watch(const Telemetry& telemetry, const TickWatch& ticks, ServiceManager* manager);

  // Looks around twenty times a second while `running`.
  void run(const std::atomic<bool>& running);

 private:
  void tell_overruns();
  void tell_of_log();
  void tell_of_faults();

  const Telemetry& telemetry_;
  const TickWatch& ticks_;
  ServiceManager* manager_;
  const int faults_signal_;
  const int state_signal_;
  std::vector<double> values_;
  std::uint32_t faults_ = 0;
  Telemetry::LogStatus log_;
  std::uint64_t overruns_told_ = 0;
  std::chrono::steady_clock::time_point next_told_;
};

}  // namespace gaitd::daemon
