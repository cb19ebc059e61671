// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "daemon/control/tick_data.h"
#include "daemon/telemetry/signal.h"

namespace gaitd::daemon {

// The signals of a tick: their table and their values, from one enumeration of both.
SignalTable make_signal_table(const GaitdModel& model, bool truth);
// `values` has one entry per signal of the table made for the same model and truth. [rt]
void record_signals(const GaitdModel& model, const TickData& data, std::span<double> values);

}  // namespace gaitd::daemon
