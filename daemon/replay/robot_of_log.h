// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "daemon/config/robot.h"
#include "daemon/config/settings.h"
#include "daemon/log/log_reader.h"

namespace gaitd::daemon {

// The robot as the log holds it, without any file. Nothing, with why in `error`, if it does not or
// it cannot be read. `settings` takes the parameters of robot.yaml; may be null.
std::optional<Robot> robot_of_log(const LogReader& log, Settings* settings, std::string* error);

}  // namespace gaitd::daemon
