// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <time.h>

namespace gaitd::daemon {

// Wall time since construction, for reports only.
class Stopwatch {
 public:
  Stopwatch() { clock_gettime(CLOCK_MONOTONIC, &start_); }
  double microseconds() const {
    timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return 1e6 * static_cast<double>(now.tv_sec - start_.tv_sec) +
           1e-3 * static_cast<double>(now.tv_nsec - start_.tv_nsec);
  }

 private:
  timespec start_;
};

}  // namespace gaitd::daemon
