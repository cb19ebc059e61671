// SPDX-License-Identifier: Apache-2.0
#include "invariant_ekf.h"

GAITD_EXPORT_LAYER(gaitd::plugins::InvariantEkf, GAITD_LAYER_STATE_ESTIMATOR, "invariant_ekf",
                   "0.1.0", 120.0)
