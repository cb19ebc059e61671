// SPDX-License-Identifier: Apache-2.0
#include "arm_swing.h"

GAITD_EXPORT_LAYER(gaitd::plugins::ArmSwing, GAITD_LAYER_TASK_SOURCE, "arm_swing", "0.1.0", 100.0)
