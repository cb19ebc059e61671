// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace gaitd::cli {

/// Has `handler` called for `signal`.
void handle_signal(int signal, void (*handler)(int));

/// Takes SIGTSTP (Ctrl-Z) while it lives, so that a terminal is left in order first. One at a time.
class SuspendSignal {
 public:
  SuspendSignal();
  ~SuspendSignal();
  SuspendSignal(const SuspendSignal&) = delete;
  SuspendSignal& operator=(const SuspendSignal&) = delete;

  static bool requested();
  /// Stops this process; returns when it goes on. At once where no shell could let it go on.
  static void suspend();
};

}  // namespace gaitd::cli
