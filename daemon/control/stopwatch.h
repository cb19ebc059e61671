// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <time.h>

namespace gaitd::daemon {

// Time since construction by one of the clocks of the system.
template <clockid_t kClock>
class BasicStopwatch {
 public:
  BasicStopwatch() { clock_gettime(kClock, &start_); }
  double microseconds() const {
    timespec now;
    clock_gettime(kClock, &now);
    return 1e6 * static_cast<double>(now.tv_sec - start_.tv_sec) +
           1e-3 * static_cast<double>(now.tv_nsec - start_.tv_nsec);
  }

 private:
  timespec start_;
};

// Wall time, for reports only.
using Stopwatch = BasicStopwatch<CLOCK_MONOTONIC>;
// Of the processor, used by this thread alone. A system call: not for every tick.
using ThreadStopwatch = BasicStopwatch<CLOCK_THREAD_CPUTIME_ID>;

}  // namespace gaitd::daemon
