// SPDX-License-Identifier: Apache-2.0
#pragma once

// Defined by what a test preloads to watch the real-time path (tests/rt_guard); else null.
extern "C" {
__attribute__((weak)) void gaitd_tick_begins();
__attribute__((weak)) void gaitd_tick_ends();
}

namespace gaitd::daemon {

// Marks the guarded section of the tick: from reading the sensors to handing over commands and log.
class TickGuard {
 public:
  TickGuard() {
    if (gaitd_tick_begins != nullptr) gaitd_tick_begins();
  }
  ~TickGuard() {
    if (gaitd_tick_ends != nullptr) gaitd_tick_ends();
  }
  TickGuard(const TickGuard&) = delete;
  TickGuard& operator=(const TickGuard&) = delete;
};

}  // namespace gaitd::daemon
