// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "daemon/config/robot.h"
#include "daemon/telemetry/log_writer.h"
#include "gaitd/abi/types.h"

namespace gaitd::daemon {

// The files of the robot and how its control began: what replay needs besides the settings.
void add_replay_metadata(const Robot& robot, nlohmann::json start, LogMetadata* metadata);

// What whoever draws it needs: its name, robot.yaml as JSON, the text of its URDF.
nlohmann::json robot_description(const Robot& robot);

// What the verdict needs to know of the robot (daemon/verdict/verdict.h), and who draws it.
void add_robot_metadata(const Robot& robot, LogMetadata* metadata);

}  // namespace gaitd::daemon
