// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "daemon/usage/completion.h"

namespace gaitd::cli {

/// Exit codes of gaitctl.
inline constexpr int kDone = 0;
inline constexpr int kFailed = 1;  // the daemon refused, or the run failed
inline constexpr int kUsage = 2;
inline constexpr int kNoDaemon = 3;
inline constexpr int kDamaged = 4;        // done, but the log that was read is damaged
inline constexpr int kInterrupted = 130;  // as a shell reports a program that SIGINT ended

/// What the command line said, shared by all commands. Parsing only chooses the action; main() runs
/// it afterwards.
struct Context {
  std::string socket;  ///< of --socket; empty: look in the usual places
  bool json = false;
  std::function<int()> action;
  usage::ValueSources values;  ///< what completion offers for an option beyond its fixed words
};

}  // namespace gaitd::cli
