// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

#include "daemon/host/plugin_file.h"
#include "daemon/host/probe.h"
#include "daemon/host/refusal.h"

namespace gaitd::daemon {

/// The code of a library in this process, for one user at a time. When that one has gone it is
/// unmapped, unless it would not go (STB_GNU_UNIQUE, NODELETE) or its libraries would go with it,
/// which may have threads. Such a one stays idle, and is what the next user of the same bytes gets;
/// there are at most bounds::kIdleLibraries of them.
class LibraryImage {
 public:
  /// Stages a copy, or takes an idle one, probes it in a child process unless `probe_options` is
  /// null, and maps it with all symbols bound. Null with the reason in `refusal`. Any thread but
  /// the real-time one.
  static std::unique_ptr<LibraryImage> map(const PluginFile& file, const GaitdModel& model,
                                           const ProbeOptions* probe_options, Refusal* refusal);
  /// Unmaps it or lays it aside.
  static void release(std::unique_ptr<LibraryImage> image);
  /// Leaves it mapped for ever; nobody else gets it.
  static void keep(std::unique_ptr<LibraryImage> image);

  void* handle() const { return handle_; }  ///< of dlopen

 private:
  explicit LibraryImage(StagedCopy copy) : copy_(std::move(copy)) {}
  bool open(const PluginFile& file, Refusal* refusal);
  bool is_mapped();  // if so, its handle is good
  bool unmap();

  StagedCopy copy_;  // as long as it is mapped: its path must not come again
  void* handle_ = nullptr;
  bool alone_ = false;  // it brought no other library
};

}  // namespace gaitd::daemon
