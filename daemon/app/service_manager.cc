// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/service_manager.h"

#include <pthread.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace gaitd::daemon {
namespace {

constexpr auto kFeedPeriod = std::chrono::milliseconds(50);

}  // namespace

ServiceManager::ServiceManager(std::function<std::uint64_t()> rounds) : rounds_(std::move(rounds)) {
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
    return;
  }
  feeder_ = std::thread([this] { feed(); });
  pthread_setname_np(feeder_.native_handle(), "gaitd-watchdog");
}

ServiceManager::~ServiceManager() {
  stopping_ = true;
  if (feeder_.joinable()) feeder_.join();
  send("STOPPING=1");
  if (socket_ >= 0) close(socket_);
}

void ServiceManager::send(const std::string& text) const {
  // A manager that does not take it is not our concern; the watchdog tells.
  if (socket_ >= 0) (void)!::send(socket_, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
}

void ServiceManager::feed() {
  for (std::uint64_t last = 0; !stopping_;) {
    const std::uint64_t rounds = rounds_();
    if (last == 0 && rounds != 0) send("READY=1");
    if (watchdog_ && rounds != last) send("WATCHDOG=1");
    last = rounds;
    std::this_thread::sleep_for(kFeedPeriod);
  }
}

void ServiceManager::tell(const std::string& state) {
  if (state == last_state_) return;
  last_state_ = state;
  send("STATUS=" + state);
}

}  // namespace gaitd::daemon
