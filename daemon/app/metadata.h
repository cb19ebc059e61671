// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "daemon/app/realtime.h"
#include "daemon/config/robot.h"
#include "daemon/control/tick_watch.h"
#include "daemon/telemetry/log_writer.h"
#include "daemon/telemetry/telemetry.h"
#include "gaitd/abi/types.h"

namespace gaitd::daemon {

// The files of the robot and how its control began: what replay needs besides the settings.
void add_replay_metadata(const Robot& robot, nlohmann::json start, LogMetadata* metadata);

// What the verdict needs to know of the robot (daemon/verdict/verdict.h).
void add_robot_metadata(const GaitdModel& model, LogMetadata* metadata);

// The snapshot that `status` answers with, from the newest tick that telemetry has seen.
nlohmann::json status_of(const Telemetry& telemetry);
// Adds where the time of the ticks went since the start, and what of real time there is.
void add_times(const TickWatch::Report& report, const RealtimeReport& realtime,
               nlohmann::json* status);

}  // namespace gaitd::daemon
