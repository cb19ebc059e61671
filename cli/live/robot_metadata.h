// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "daemon/telemetry/log_writer.h"

namespace gaitd::cli {

/// What a log says of the robot that robot.describe has described.
daemon::LogMetadata log_metadata_of(const nlohmann::json& robot);

}  // namespace gaitd::cli
