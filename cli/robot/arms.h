// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/robot/guess.h"

namespace gaitd::porting {

// Positions of the joints in `q`, rad, that belong to no leg: near zero, away from the stops, and
// arms so that their mass hangs low but beside the body.
void hang_arms(const Guess& guess, Eigen::VectorXd* q);

}  // namespace gaitd::porting
