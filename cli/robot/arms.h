// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/robot/guess.h"

namespace gaitd::porting {

// For every body of the model, where its arm begins: m to the left of the middle of the robot, 0
// for bodies of no arm. An arm is whatever hangs beside the middle, and is no leg.
std::vector<double> arms_begin(const Guess& guess);

// Positions of the joints in `q`, rad, that belong to no leg: near zero, away from the stops, and
// arms so that their mass hangs low but beside the body.
void hang_arms(const Guess& guess, Eigen::VectorXd* q);

}  // namespace gaitd::porting
