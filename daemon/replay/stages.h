// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace gaitd::daemon {

/// The stage of the tick that writes a signal, and its place in the tick. "": none that a replay
/// recomputes (wall times, raw sensors, truth).
struct SignalStage {
  std::string_view name;
  int place = 0;
};
SignalStage stage_of(std::string_view signal);

}  // namespace gaitd::daemon
