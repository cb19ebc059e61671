// SPDX-License-Identifier: Apache-2.0
#include "com_height_qp.h"

GAITD_EXPORT_LAYER(gaitd::plugins::ComHeightQp, GAITD_LAYER_WHOLE_BODY_CONTROLLER, "com_height_qp",
                   "0.1.0", 600.0)
