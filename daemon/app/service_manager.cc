// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/service_manager.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>

namespace gaitd::daemon {

ServiceManager::ServiceManager() {
  const char* path = std::getenv("NOTIFY_SOCKET");
  watchdog_ = std::getenv("WATCHDOG_USEC") != nullptr;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path == nullptr || std::strlen(path) >= sizeof(address.sun_path)) return;
  std::strcpy(address.sun_path, path);
  const std::size_t length = offsetof(sockaddr_un, sun_path) + std::strlen(path);
  if (path[0] == '@') address.sun_path[0] = '\0';  // an abstract name
  socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket_ < 0) return;
  if (connect(socket_, reinterpret_cast<sockaddr*>(&address), static_cast<socklen_t>(length)) !=
      0) {
    close(socket_);
    socket_ = -1;
  }
}

ServiceManager::~ServiceManager() {
  if (socket_ >= 0) close(socket_);
}

void ServiceManager::send(const std::string& text) {
  // A manager that does not take it is not our concern; the watchdog tells.
  if (socket_ >= 0) (void)!::send(socket_, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
}

void ServiceManager::update(std::int64_t tick, const std::string& state) {
  if (socket_ < 0 || tick < 0) return;
  if (!ready_) send("READY=1");
  ready_ = true;
  if (watchdog_ && tick != last_tick_) send("WATCHDOG=1");
  last_tick_ = tick;
  if (state == last_state_) return;
  last_state_ = state;
  send("STATUS=" + state);
}

void ServiceManager::stopping() { send("STOPPING=1"); }

}  // namespace gaitd::daemon
