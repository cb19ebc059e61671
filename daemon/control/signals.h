// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "daemon/control/tick_data.h"
#include "daemon/log/signal.h"

namespace gaitd::daemon {

// Names of the variants that each layer may have, in the order that TickData counts them.
using LayerVariants = std::array<std::vector<std::string>, GAITD_LAYER_COUNT>;

// Signals of the time that each layer took, below `tick/`.
inline constexpr std::array<const char*, GAITD_LAYER_COUNT> kLayerTimes = {
    "estimator_us", "planner_us", "adjuster_us", "toe_off_us", "wbc_us", "tasks_us"};

// The signals of a tick: their table and their values, from one enumeration of both.
SignalTable make_signal_table(const GaitdModel& model, const LayerVariants& variants, bool truth);
// `values` has one entry per signal of the table made for the same model and truth. [rt]
void record_signals(const GaitdModel& model, const TickData& data, std::span<double> values);

}  // namespace gaitd::daemon
