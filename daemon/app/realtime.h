// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "daemon/app/cpu_latency.h"
#include "daemon/config/daemon_config.h"

namespace gaitd::daemon {

// What the process got of what real time needs. `degraded` lists what is missing, each with why and
// what to do.
struct RealtimeReport {
  std::vector<std::string> got;
  std::vector<std::string> degraded;
};

// Locks the memory of the process, present and future. To be called before the control thread.
void lock_memory(const RealtimeConfig& config, RealtimeReport* report);
// Keeps idle processors as awake as configured, as long as `latency` lives.
void stay_awake(const RealtimeConfig& config, CpuLatency* latency, RealtimeReport* report);
// On the control thread: SCHED_FIFO, affinity, a stack that has been touched.
void enter_realtime(const RealtimeConfig& config, RealtimeReport* report);

}  // namespace gaitd::daemon
