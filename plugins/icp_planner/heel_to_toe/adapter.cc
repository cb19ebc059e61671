// SPDX-License-Identifier: Apache-2.0
#include "heel_to_toe.h"

GAITD_EXPORT_LAYER(gaitd::plugins::HeelToToe, GAITD_LAYER_ICP_PLANNER, "heel_to_toe", "0.1.0", 60.0)
