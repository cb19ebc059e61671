// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "daemon/control/pipeline.h"
#include "daemon/log/log_reader.h"

namespace gaitd::daemon {

struct ReplayOptions {
  std::vector<std::filesystem::path> plugin_folders;
  std::vector<std::string> set;  ///< KEY=VALUE, over what was recorded: then it will differ
  /// For those who look closer; may be empty. The first is called when the commands and swaps of a
  /// tick were taken and its sensors are there.
  std::function<void(const GaitdModel&, std::int64_t tick, Pipeline&)> before_tick;
  std::function<void(const TickData&)> after_tick;
  /// A log names the files of its libraries. Code is loaded from them only if this is set; else
  /// only installed variants are, whatever the log says.
  bool trust = false;
};

/// A signal that is not what was recorded, bit by bit.
struct SignalDifference {
  std::string signal;
  std::string stage;  ///< of the tick, that writes it: a layer, "gait machine", "objectives", ...
  std::int64_t tick = 0;  ///< the first one that differs
  double recorded = 0.0;  ///< then
  double replayed = 0.0;
  double largest = 0.0;  ///< difference over all ticks
};

struct ReplayReport {
  std::int64_t ticks = 0;                     ///< replayed
  std::size_t signals = 0;                    ///< compared in each
  std::vector<SignalDifference> differences;  ///< the first first: by tick, then by stage
  std::vector<std::string> notes;             ///< e.g. plugins of another build, an early end
};

/// Feeds the recorded sensors, commands, parameter changes and swaps to the gait machine and the
/// layers, as fast as they go, and compares every signal that they write. Of a damaged log the
/// ticks before the first that is missing. Nothing with `error` if the log does not hold what it
/// takes.
std::optional<ReplayReport> replay(const LogReader& log, const ReplayOptions& options,
                                   std::string* error);

}  // namespace gaitd::daemon
