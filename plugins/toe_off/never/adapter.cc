// SPDX-License-Identifier: Apache-2.0
#include "never.h"

GAITD_EXPORT_LAYER(gaitd::plugins::Never, GAITD_LAYER_TOE_OFF, "never", "0.1.0", 5.0)
