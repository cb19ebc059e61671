// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>

#include "daemon/host/refusal.h"
#include "gaitd/abi/types.h"

namespace gaitd::daemon {

struct ProbeOptions {
  /// The program started as the child: one that links this library. It probes before main().
  std::filesystem::path executable = "/proc/self/exe";
  std::chrono::milliseconds timeout{10000};   ///< wall time, loading to destruction
  const std::atomic<bool>* cancel = nullptr;  ///< true ends the child and refuses the library
};

/// Tries a library in a child process: loads it, makes an instance and, for a control layer,
/// initialises it with `model` and the default parameters, activates, deactivates and destroys it,
/// and unloads it. A crash, a hang, a missing symbol or an exit before all that is done is a reason
/// in `refusal`, with the step it happened in. A backend is only made and destroyed, since its
/// start touches hardware. `library_fd` is open on the library.
///
/// The child is started by posix_spawn, not by fork: a fork would copy-on-write the memory of the
/// running real-time thread and fault it. Any thread but the real-time one may call this.
/// Returns true if the library survived.
bool probe(int library_fd, const GaitdModel& model, Refusal* refusal,
           const ProbeOptions& options = {});

}  // namespace gaitd::daemon
