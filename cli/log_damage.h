// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

#include "daemon/log/log_reader.h"

namespace gaitd::cli {

/// Every command that has used a log ends with this. Says on standard error what of the log is
/// damaged or missing, and if checksums cover only a part of it. Returns the exit code: kDamaged if
/// there is any damage, whatever the command found in what is left; else `done`.
int tell_damage(std::string_view command, const daemon::LogReader& log, int done);

/// The same for --json: {"damage": [texts], "lost_ticks", "lost": [{first, last, from, to}]}. Added
/// to the result of the command.
void add_damage(const daemon::LogReader& log, nlohmann::json* result);

}  // namespace gaitd::cli
