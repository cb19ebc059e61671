// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/realtime.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

namespace gaitd::daemon {
namespace {

constexpr std::size_t kStackTouched = 512 * 1024;

void touch_stack() {
  [[maybe_unused]] volatile char stack[kStackTouched];
  for (std::size_t i = 0; i < kStackTouched; i += 1024) stack[i] = 0;
}

std::string first_line(const char* file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

}  // namespace

void lock_memory(const RealtimeConfig& config, RealtimeReport* report) {
  if (!config.lock_memory) {
    report->degraded.push_back("memory is not locked (realtime.lock_memory: false)");
  } else if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) {
    report->got.push_back("memory locked");
  } else {
    report->degraded.push_back(std::string("memory is not locked: ") + std::strerror(errno) +
                               "; raise the memlock limit (LimitMEMLOCK=infinity)");
  }
  if (first_line("/sys/kernel/realtime") == "1") {
    report->got.push_back("PREEMPT_RT kernel");
  } else {
    report->degraded.push_back(
        "the kernel is not PREEMPT_RT: wake-ups may be late by milliseconds");
  }
}

void stay_awake(const RealtimeConfig& config, CpuLatency* latency, RealtimeReport* report) {
  if (config.cpu_latency >= RealtimeConfig::kAnyCpuLatency) return;
  std::string error;
  if (!latency->hold(config.cpu_latency, &error)) {
    report->degraded.push_back(error);
  } else if (latency->held()) {
    char text[80];
    std::snprintf(text, sizeof(text), "idle processors wake up within %.0f us (PM QoS)",
                  1e6 * config.cpu_latency);
    report->got.push_back(text);
  }
}

void enter_realtime(const RealtimeConfig& config, RealtimeReport* report) {
  touch_stack();
  report->got.push_back(std::string("built for ") + GAITD_BUILD + ", denormals are flushed");
  if (std::string(GAITD_BUILD).find("Release") == std::string::npos) {
    report->degraded.push_back("not a release build: build with the preset release");
  }
  sched_param param{};
  param.sched_priority = config.priority;
  if (const int e = pthread_setschedparam(pthread_self(), SCHED_FIFO, &param); e == 0) {
    report->got.push_back("SCHED_FIFO " + std::to_string(config.priority));
  } else {
    report->degraded.push_back(std::string("no SCHED_FIFO: ") + std::strerror(e) +
                               "; raise the rtprio limit (LimitRTPRIO=99); kernels with "
                               "RT_GROUP_SCHED give a new cgroup no real-time budget");
  }
  if (config.affinity.empty()) return;
  cpu_set_t set;
  CPU_ZERO(&set);
  for (int cpu : config.affinity) CPU_SET(cpu, &set);
  if (const int e = pthread_setaffinity_np(pthread_self(), sizeof(set), &set); e == 0) {
    report->got.push_back("affinity set");
  } else {
    report->degraded.push_back(std::string("affinity not set: ") + std::strerror(e) +
                               "; check realtime.affinity against the processors of this machine");
  }
}

}  // namespace gaitd::daemon
