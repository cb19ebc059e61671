// SPDX-License-Identifier: Apache-2.0
#include "icp_criteria.h"

GAITD_EXPORT_LAYER(gaitd::plugins::IcpCriteria, GAITD_LAYER_TOE_OFF, "icp_criteria", "0.1.0", 30.0)
