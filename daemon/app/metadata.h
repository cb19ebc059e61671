// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "daemon/telemetry/log_writer.h"
#include "daemon/telemetry/telemetry.h"
#include "gaitd/abi/types.h"

namespace gaitd::daemon {

// What the verdict needs to know of the robot (daemon/verdict/verdict.h).
void add_robot_metadata(const GaitdModel& model, LogMetadata* metadata);

// The snapshot that `status` answers with, from the newest tick that telemetry has seen.
nlohmann::json status_of(const Telemetry& telemetry);

}  // namespace gaitd::daemon
