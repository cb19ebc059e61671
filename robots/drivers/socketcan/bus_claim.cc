// SPDX-License-Identifier: Apache-2.0
#include "bus_claim.h"

#include <net/if.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <utility>

namespace gaitd::can {

BusClaim::~BusClaim() {
  if (socket_ >= 0) close(socket_);
}

BusClaim::BusClaim(BusClaim&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}

BusClaim& BusClaim::operator=(BusClaim&& other) noexcept {
  std::swap(socket_, other.socket_);
  return *this;
}

std::string BusClaim::take(const std::string& interface) {
  // By number: an interface can be renamed.
  const unsigned number = if_nametoindex(interface.c_str());
  if (number == 0) return "";
  const std::string name = "gaitd-can-" + std::to_string(number);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::copy(name.begin(), name.end(), address.sun_path + 1);  // abstract: after a zero
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  BusClaim claim;
  claim.socket_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (claim.socket_ < 0 ||
      bind(claim.socket_, reinterpret_cast<const sockaddr*>(&address), size) != 0) {
    if (errno != EADDRINUSE) return interface + ": cannot be claimed: " + std::strerror(errno);
    return interface +
           ": another process commands its motors already, and two would switch off each other's; "
           "stop that one first (`ss -xap | grep @" +
           name + "` names it)";
  }
  std::swap(socket_, claim.socket_);
  return "";
}

}  // namespace gaitd::can
