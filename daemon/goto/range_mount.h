// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "gaitd/abi/model.h"
#include "gaitd/sim/range_sensor_keys.h"

namespace gaitd::daemon {

// The simulated sensor of a scenario's section `perception` on the robot, with the figures of its
// class where the section has none. Without a link it is on the front of the chest (body 0 without
// one), in the nominal posture 0.2 pelvis heights before and 0.55 above the pelvis; a camera looks
// 0.95 rad down.
sim::RangeSensorFigures range_sensor(const nlohmann::json& perception, const GaitdModel& model);

}  // namespace gaitd::daemon
