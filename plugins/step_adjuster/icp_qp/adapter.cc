// SPDX-License-Identifier: Apache-2.0
#include "icp_qp.h"

GAITD_EXPORT_LAYER(gaitd::plugins::IcpQp, GAITD_LAYER_STEP_ADJUSTER, "icp_qp", "0.1.0", 50.0)
