// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

#include "daemon/control/pipeline.h"

namespace gaitd::daemon {

// Texts (JSON) of events about the safety machine, written to `text`. [rt]

// The state, the faults and what is behind them.
std::string_view state_text(const Pipeline& pipeline, char* text, std::size_t size);
// A joint that was dropped, and why.
std::string_view dropped_text(const SensorMonitor& monitor, int joint, char* text,
                              std::size_t size);

}  // namespace gaitd::daemon
