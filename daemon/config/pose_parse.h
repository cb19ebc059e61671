// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "daemon/config/yaml_reader.h"
#include "gaitd/walking/commands.h"

namespace gaitd::daemon {

// Reads the parameters of `pose`: one of pelvis, chest, arm and hand with where it is to be, or
// with the `points` of a way. `model` may be null: then joints are not looked for.
void read_pose(MapReader* map, const GaitdModel* model, walking::MotionCommand* command);

}  // namespace gaitd::daemon
