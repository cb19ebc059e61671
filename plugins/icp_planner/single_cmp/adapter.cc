// SPDX-License-Identifier: Apache-2.0
#include "single_cmp.h"

GAITD_EXPORT_LAYER(gaitd::plugins::SingleCmp, GAITD_LAYER_ICP_PLANNER, "single_cmp", "0.1.0", 60.0)
