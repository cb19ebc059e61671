// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/cpu_latency.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace gaitd::daemon {

CpuLatency::~CpuLatency() {
  if (file_ >= 0) close(file_);
}

bool CpuLatency::hold(double seconds, std::string* error, const char* device) {
  const int file = open(device, O_WRONLY | O_CLOEXEC);
  if (file < 0 && errno == ENOENT) return true;
  // The kernel takes whole µs, as four bytes; the request ends with the file.
  const auto us =
      static_cast<std::int32_t>(std::lround(1e6 * std::clamp(seconds, 0.0, kMaxSeconds)));
  if (file >= 0 && write(file, &us, sizeof(us)) == static_cast<ssize_t>(sizeof(us))) {
    if (file_ >= 0) close(file_);
    file_ = file;
    return true;
  }
  *error = std::string("idle processors may sleep: ") + device + ": " + std::strerror(errno) +
           "; let gaitd write it (the package's udev rule gives it to the group gaitd)";
  if (file >= 0) close(file);
  return false;
}

}  // namespace gaitd::daemon
