// SPDX-License-Identifier: Apache-2.0
#include "nullspace_qp.h"

GAITD_EXPORT_LAYER(gaitd::plugins::NullspaceQp, GAITD_LAYER_WHOLE_BODY_CONTROLLER, "nullspace_qp",
                   "0.1.0", 600.0)
