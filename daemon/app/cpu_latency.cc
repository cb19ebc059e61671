// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/cpu_latency.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

namespace gaitd::daemon {

CpuLatency::~CpuLatency() {
  if (file_ >= 0) close(file_);
}

bool CpuLatency::hold(double seconds, std::string* error) {
  file_ = open(device_.c_str(), O_WRONLY | O_CLOEXEC);
  if (file_ < 0 && errno == ENOENT) return true;
  // The kernel takes whole µs, as four bytes; the request ends with the file.
  const auto us = static_cast<std::int32_t>(std::lround(1e6 * seconds));
  if (file_ >= 0 && write(file_, &us, sizeof(us)) == static_cast<ssize_t>(sizeof(us))) return true;
  *error = "idle processors may sleep: " + device_ + ": " + std::strerror(errno) +
           "; let gaitd write it (the package's udev rule gives it to the group gaitd)";
  if (file_ >= 0) close(std::exchange(file_, -1));
  return false;
}

}  // namespace gaitd::daemon
