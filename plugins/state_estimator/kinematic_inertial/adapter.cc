// SPDX-License-Identifier: Apache-2.0
#include "kinematic_inertial.h"

GAITD_EXPORT_LAYER(gaitd::plugins::KinematicInertial, GAITD_LAYER_STATE_ESTIMATOR,
                   "kinematic_inertial", "0.1.0", 60.0)
