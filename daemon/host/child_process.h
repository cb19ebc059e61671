// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "gaitd/abi/types.h"

namespace gaitd::daemon {

/// A child process that runs code of a plugin, so that what it breaks is not this process.
struct ChildRequest {
  /// A program that takes the role of the child by its arguments, before main().
  std::filesystem::path executable = "/proc/self/exe";
  std::vector<std::string> arguments;
  const GaitdModel* model = nullptr;          ///< handed to the child
  std::vector<int> library_fds;               ///< handed to the child
  std::chrono::milliseconds timeout{10000};   ///< wall time until it is killed
  const std::atomic<bool>* cancel = nullptr;  ///< true ends the child within 50 ms
};

struct ChildEnd {
  std::string start_error;  ///< why there was no child; empty if there was one
  std::string report;       ///< lines that the child wrote, after an empty one
  bool killed = false;      ///< at the end of its time
  bool cancelled = false;   ///< before that, by the request
  int status = 0;           ///< of waitpid
  std::chrono::milliseconds timeout{0};

  /// The last line of the report that begins with `key`, without it.
  std::string last(const std::string& key) const;
  /// A crash, a hang or an exit that the child did not announce, with whatever code, in words; else
  /// empty.
  std::string abnormal_end() const;
};

/// Runs the child to its end. It is started by posix_spawn, not by fork: a fork would copy-on-write
/// the memory of a running real-time thread and fault it. Any thread but that one may call this. A
/// child starts no child: there is one level of them, whatever `executable` turns out to do.
ChildEnd run_child(const ChildRequest& request);

}  // namespace gaitd::daemon
