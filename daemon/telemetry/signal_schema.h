// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "daemon/log/signal.h"

namespace gaitd::daemon {

inline constexpr char kSignalsMessage[] = "gaitd.telemetry.Signals";

// The serialised google.protobuf.FileDescriptorSet that describes the message of a tick: what makes
// a log open in tools that have never heard of gaitd. The table must be valid.
std::string signal_schema(const SignalTable& table);

}  // namespace gaitd::daemon
