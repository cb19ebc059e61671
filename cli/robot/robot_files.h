// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/robot/guess.h"

namespace gaitd::porting {

// robot.yaml, each guess with its reasons as a comment. `urdf`: the file as robot.yaml names it.
std::string robot_yaml(const Guess& guess, const std::string& urdf);

// Scenarios beside robot.yaml: five seconds of standing, and a first walk of six steps.
std::string stand_scenario(const Guess& guess);
std::string walk_scenario(const Guess& guess);

}  // namespace gaitd::porting
