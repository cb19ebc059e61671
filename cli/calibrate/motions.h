// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "gaitd/abi/types.h"

namespace gaitd::calibrate {

// The motions that calibrate a robot, as a scenario (gaitd.scenario/1): it hangs and swings the
// joints of its legs one by one, slowly and fast, is armed and lowered, and moves its pelvis on
// both feet in four stances. Which way a joint swings and how far follows from the legs, their
// ranges and the posture of the model; lengths from its height. `robot` is its name or the
// path of its robot.yaml, as the scenario is to name it.
std::string motions_yaml(const GaitdModel& model, const std::string& robot);

}  // namespace gaitd::calibrate
