// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cli/robot/guess.h"

namespace gaitd::porting {

// Times, lengths and forces of a first walk, from those that Atlas walks with: lengths go with the
// height of the centre of mass, times with its root, forces with the weight.
void find_proportions(Guess* guess);

// Parameters that are lengths or speeds, scaled from their defaults; none for a robot of about the
// size of Atlas, which walks with the defaults.
std::vector<std::pair<std::string, double>> scaled_parameters(const Proportions& proportions);

}  // namespace gaitd::porting
