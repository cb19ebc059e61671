// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>

namespace gaitd::daemon {

// What systemd is told through $NOTIFY_SOCKET; without one nothing happens. No call waits: a
// message that the manager does not take is dropped. The watchdog is fed by a thread that does
// nothing else, as long as the control loop makes rounds.
class ServiceManager {
 public:
  // `rounds`: how many the control loop has made.
  explicit ServiceManager(std::function<std::uint64_t()> rounds);
  ~ServiceManager();  // STOPPING=1
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;

  // `state` is shown by `systemctl status`. From one thread.
  void tell(const std::string& state);

 private:
  void feed();
  void send(const std::string& text) const;

  int socket_ = -1;
  bool watchdog_ = false;
  std::function<std::uint64_t()> rounds_;
  std::string last_state_;
  std::atomic<bool> stopping_{false};
  std::thread feeder_;
};

}  // namespace gaitd::daemon
