// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "daemon/log/log_reader.h"

namespace gaitd::daemon {

// What `gaitctl log info` prints: duration, ticks, dropouts, size, topics, metadata, events.
std::string log_info_text(const LogReader& log);
std::string log_info_json(const LogReader& log);

// What of it is damaged: {"damage": [texts], "lost_ticks", "lost": [{"first", "last", "from",
// "to"}]}; times in s, null at an end of the log.
nlohmann::json log_damage_json(const LogReader& log);

}  // namespace gaitd::daemon
