// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/doctor/finding.h"
#include "gaitd/abi/types.h"

namespace gaitd::doctor {

// What makes a robot.yaml and its URDF suspicious beyond what gaitd refuses, and what the robot can
// do in its standing posture. Files that gaitd refuses give its errors as problems.
Findings diagnose_robot(const std::string& robot_yaml);

// Masses, inertias, limits that look like placeholders.
Findings check_bodies(const GaitdModel& model);
// Frames that look flipped, legs that are no mirror images.
Findings check_frames(const GaitdModel& model);
// Of the nominal posture: reach of the legs, torques, where the ICP stands.
Findings check_posture(const GaitdModel& model);

}  // namespace gaitd::doctor
