// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "daemon/log/log_reader.h"

namespace gaitd::daemon {

// What `gaitctl log info` prints: duration, ticks, dropouts, size, topics, metadata, events.
std::string log_info_text(const LogReader& log);
std::string log_info_json(const LogReader& log);

}  // namespace gaitd::daemon
