// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace gaitd::daemon {

// What systemd is told through $NOTIFY_SOCKET; without one nothing happens. The watchdog is only
// fed while the control thread makes ticks.
class ServiceManager {
 public:
  ServiceManager();
  ~ServiceManager();
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;

  // Once per poll, from a thread that may block: `tick` is the newest, -1 before the first;
  // `state` is shown by `systemctl status`.
  void update(std::int64_t tick, const std::string& state);
  void stopping();

 private:
  void send(const std::string& text);

  int socket_ = -1;
  bool watchdog_ = false;
  bool ready_ = false;
  std::int64_t last_tick_ = -1;
  std::string last_state_;
};

}  // namespace gaitd::daemon
