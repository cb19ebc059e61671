// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "daemon/app/application.h"
#include "daemon/config/issues.h"

namespace gaitd::daemon {

// Puts the file that is to be checked where its schema says: configuration, robot or scenario.
// False when it has none of them; what is wrong goes to `issues`.
bool choose_checked_file(Options* options, Issues* issues);

// Reports a place for logs where nothing can be written. What is not configured is not looked at.
void check_log(const LogConfig& log, const Location& where, Issues* issues);

}  // namespace gaitd::daemon
