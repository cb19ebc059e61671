// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cli/robot/guess.h"

namespace gaitd::porting {

// Names and texts of the files that describe the robot of a URDF: robot.yaml, two scenarios and a
// picture. `named`: the URDF as robot.yaml shall name it. None and why in `error` when the robot
// cannot be described.
std::vector<std::pair<std::string, std::string>> describe_robot(const std::string& urdf,
                                                                const std::string& named,
                                                                const std::string& name,
                                                                const Told& told,
                                                                std::string* error);

}  // namespace gaitd::porting
