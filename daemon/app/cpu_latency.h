// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

namespace gaitd::daemon {

/// Asks the kernel to let no processor fall asleep deeper than it can wake up from in a given time
/// (PM QoS, Documentation/power/pm_qos_interface.rst), for as long as this object lives. A
/// processor that has to be woken first costs a periodic thread tens of microseconds each time.
class CpuLatency {
 public:
  explicit CpuLatency(std::string device = "/dev/cpu_dma_latency") : device_(std::move(device)) {}
  ~CpuLatency();
  CpuLatency(const CpuLatency&) = delete;
  CpuLatency& operator=(const CpuLatency&) = delete;

  /// Once. `seconds`: 0..2000; 0 lets idle processors spin. False with `error`, with what to do
  /// about it. A kernel without idle states has no such device: true, and held() stays false.
  bool hold(double seconds, std::string* error);
  bool held() const { return file_ >= 0; }

 private:
  const std::string device_;
  int file_ = -1;
};

}  // namespace gaitd::daemon
