// SPDX-License-Identifier: Apache-2.0
#include "cli/doctor/machine_doctor.h"

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <system_error>
#include <thread>

namespace gaitd::doctor {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr rlim_t kMemory = 1u << 30;  // bytes that gaitd may want to lock
constexpr int kWakeUps = 300;
constexpr auto kPeriod = std::chrono::milliseconds(1);
constexpr double kLate = 0.3;  // ms
constexpr int kArpCan = 280;   // ARPHRD_CAN
constexpr char kIdleDevice[] = "/dev/cpu_dma_latency";

std::string first_line(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

// Tries it on a thread that ends right away.
int try_fifo() {
  int error = 0;
  std::thread([&error] {
    sched_param parameter{};
    parameter.sched_priority = 80;
    error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);
  }).join();
  return error;
}

Findings check_limits() {
  Findings findings;
  if (const int error = try_fifo(); error == 0) {
    findings.push_back({"priority", Severity::kOk, "SCHED_FIFO can be had", ""});
  } else {
    findings.push_back(
        {"priority", Severity::kWarning,
         std::string("this user gets no SCHED_FIFO (") + std::strerror(error) + ")",
         "LimitRTPRIO=99 in the service, or 'rtprio 99' in /etc/security/limits.d; kernels with "
         "RT_GROUP_SCHED also need a real-time budget for the cgroup"});
  }
  rlimit memory{};
  getrlimit(RLIMIT_MEMLOCK, &memory);
  const bool enough = memory.rlim_cur == RLIM_INFINITY || memory.rlim_cur >= kMemory;
  findings.push_back(
      {"memory", enough ? Severity::kOk : Severity::kWarning,
       enough ? "memory can be locked"
              : format("this user may lock only %.0f MB of memory",
                       static_cast<double>(memory.rlim_cur) / (1 << 20)),
       enough ? "" : "LimitMEMLOCK=infinity in the service, or 'memlock unlimited' in limits.d"});
  const bool sleeps = access(kIdleDevice, F_OK) == 0;
  if (sleeps && access(kIdleDevice, W_OK) != 0) {
    findings.push_back({"idle", Severity::kWarning,
                        "this user cannot keep idle processors awake: each wake-up may come tens "
                        "of microseconds late",
                        "a udev rule that lets it write /dev/cpu_dma_latency, as the package of "
                        "gaitd has for the group gaitd"});
  } else {
    findings.push_back({"idle", Severity::kOk,
                        sleeps ? "idle processors can be kept awake" : "processors never sleep",
                        ""});
  }
  return findings;
}

// How late a thread of ordinary priority is woken: no promise, but bad figures are bad news.
Findings check_wake_ups() {
  std::vector<double> late;
  auto next = Clock::now();
  for (int i = 0; i < kWakeUps; ++i) {
    next += kPeriod;
    std::this_thread::sleep_until(next);
    late.push_back(std::chrono::duration<double, std::milli>(Clock::now() - next).count());
  }
  std::sort(late.begin(), late.end());
  const double p99 = late[static_cast<std::size_t>(0.99 * kWakeUps)];
  return {
      {"wake-ups", p99 < kLate ? Severity::kOk : Severity::kWarning,
       format("%d wake-ups: 99 %% within %.2f ms, the latest %.2f ms", kWakeUps, p99, late.back()),
       p99 < kLate ? ""
                   : "other load, power saving (governor) or a virtual machine; a PREEMPT_RT "
                     "kernel, SCHED_FIFO and isolated processors (realtime.affinity)"}};
}

}  // namespace

Findings check_kernel(const fs::path& root) {
  const std::string release = first_line(root / "proc/sys/kernel/osrelease");
  if (first_line(root / "sys/kernel/realtime") == "1") {
    return {{"kernel", Severity::kOk, "PREEMPT_RT kernel " + release, ""}};
  }
  return {{"kernel", Severity::kWarning,
           "kernel " + release + " is not PREEMPT_RT: wake-ups may be late by milliseconds",
           "apt-get install linux-image-rt-amd64, and boot it; not needed for simulation"}};
}

Findings check_processors(const fs::path& root) {
  std::map<std::string, int> governors;
  for (const fs::path& cpu : entries(root / "sys/devices/system/cpu")) {
    const std::string governor = first_line(cpu / "cpufreq/scaling_governor");
    if (!governor.empty()) ++governors[governor];
  }
  std::string names;
  for (const auto& [name, count] : governors) {
    names += (names.empty() ? "" : ", ") + name + " on " + std::to_string(count);
  }
  Findings findings;
  const bool fast = governors.empty() || (governors.size() == 1 && governors.count("performance"));
  findings.push_back({"governor", fast ? Severity::kOk : Severity::kWarning,
                      governors.empty() ? "no frequency scaling in sight" : "governor: " + names,
                      fast ? "" : "cpupower frequency-set -g performance"});
  const std::string isolated = first_line(root / "sys/devices/system/cpu/isolated");
  if (!isolated.empty()) {
    findings.push_back({"isolated", Severity::kOk, "isolated processors: " + isolated,
                        "give one of them to realtime.affinity"});
  }
  return findings;
}

Findings check_can(const fs::path& root) {
  Findings findings;
  for (const fs::path& device : entries(root / "sys/class/net")) {
    if (first_line(device / "type") != std::to_string(kArpCan)) continue;
    const std::string name = device.filename();
    const std::string state = first_line(device / "operstate");
    // Virtual interfaces (vcan) do not know their state.
    const bool up = state == "up" || (state == "unknown" && name.starts_with("vcan"));
    findings.push_back({"can", up ? Severity::kOk : Severity::kProblem, name + " is " + state,
                        up ? ""
                           : "ip link set " + name +
                                 " up type can bitrate 1000000 (the bitrate of "
                                 "your drives)"});
  }
  if (findings.empty()) {
    findings.push_back({"can", Severity::kOk, "no CAN interface: simulation only", ""});
  }
  return findings;
}

Findings diagnose_machine(const fs::path& root) {
  Findings all;
  for (const Findings& some : {check_kernel(root), check_limits(), check_processors(root),
                               check_wake_ups(), check_can(root)}) {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

}  // namespace gaitd::doctor
