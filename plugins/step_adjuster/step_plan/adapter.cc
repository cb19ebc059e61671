// SPDX-License-Identifier: Apache-2.0
#include "step_plan.h"

GAITD_EXPORT_LAYER(gaitd::plugins::StepPlan, GAITD_LAYER_STEP_ADJUSTER, "step_plan", "0.1.0", 80.0)
