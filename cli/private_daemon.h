// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gaitd::cli {

/// What a private gaitd is started with.
struct DaemonRun {
  std::filesystem::path program;      ///< gaitd
  std::filesystem::path scenario;     ///< file
  std::filesystem::path log;          ///< it writes
  std::filesystem::path output;       ///< takes its standard output and error
  std::vector<std::string> settings;  ///< KEY=VALUE
  bool trust = false;                 ///< of the libraries that the scenario names
  std::string robot = {};             ///< in place of that of the scenario; may be empty
};

/// How it ended.
struct DaemonEnd {
  int exit_code = 0;
  int signal = 0;            ///< that killed it, 0 if none
  bool interrupted = false;  ///< we were asked to stop, and stopped it
};

/// Called a few times per second with the socket of the running daemon.
using Watch = std::function<void(const std::string& socket)>;

/// Starts gaitd on a scenario in lockstep, on a socket in a private directory, and waits for its
/// end. It dies with this process; SIGINT and SIGTERM to this process end it and are reported as
/// interrupted. Nothing with a reason in `error` if it could not be started.
std::optional<DaemonEnd> run_daemon(const DaemonRun& run, const Watch& watch, std::string* error);

}  // namespace gaitd::cli
