// SPDX-License-Identifier: Apache-2.0
#include "trajectory_player.h"

GAITD_EXPORT_LAYER(gaitd::plugins::TrajectoryPlayer, GAITD_LAYER_TASK_SOURCE, "trajectory_player",
                   "0.1.0", 60.0)
