// SPDX-License-Identifier: Apache-2.0
#include "clocks.h"

#include <time.h>

#include <cmath>

namespace gaitd::can {
namespace {

int64_t now_ns(clockid_t clock) {
  timespec t;
  clock_gettime(clock, &t);
  return int64_t{1000000000} * t.tv_sec + t.tv_nsec;
}

}  // namespace

int64_t Clocks::monotonic_ns() const { return now_ns(CLOCK_MONOTONIC); }
int64_t Clocks::realtime_ns() const { return now_ns(CLOCK_REALTIME); }

void Clocks::sleep(double seconds) {
  const timespec time{static_cast<time_t>(seconds),
                      static_cast<long>(1e9 * (seconds - std::floor(seconds)))};
  clock_nanosleep(CLOCK_MONOTONIC, 0, &time, nullptr);
}

Clocks& Clocks::system() {
  static Clocks clocks;
  return clocks;
}

}  // namespace gaitd::can
