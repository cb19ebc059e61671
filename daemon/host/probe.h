// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <vector>

#include "daemon/host/plugin_file.h"
#include "daemon/host/refusal.h"
#include "gaitd/abi/types.h"

namespace gaitd::daemon {

class ProvenLibraries;

struct ProbeOptions {
  /// The program started as the child: one that links this library. It probes before main().
  std::filesystem::path executable = "/proc/self/exe";
  std::chrono::milliseconds timeout{10000};   ///< wall time, loading to destruction
  const std::atomic<bool>* cancel = nullptr;  ///< true ends the child and refuses the library
  const ProvenLibraries* proven = nullptr;    ///< what need not be probed again
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

/// Libraries that survived one child process together: to start a child for each takes longer than
/// all else of a start. If anything goes wrong in it none of them is proven, and the probe of each
/// finds out which it was.
class ProvenLibraries {
 public:
  ProvenLibraries(const std::vector<std::filesystem::path>& paths, const GaitdModel& model);
  bool hold(const PluginFile& file) const;

 private:
  std::vector<StagedCopy> copies_;
};

}  // namespace gaitd::daemon
