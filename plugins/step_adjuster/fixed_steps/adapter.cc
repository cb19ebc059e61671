// SPDX-License-Identifier: Apache-2.0
#include "fixed_steps.h"

GAITD_EXPORT_LAYER(gaitd::plugins::FixedSteps, GAITD_LAYER_STEP_ADJUSTER, "fixed_steps", "0.1.0",
                   30.0)
