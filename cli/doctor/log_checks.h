// SPDX-License-Identifier: Apache-2.0
// One function per kind of trouble; each looks at one thing only and stands in its own file.
#pragma once

#include <Eigen/Core>
#include <string>

#include "cli/doctor/finding.h"
#include "cli/doctor/log_case.h"

namespace gaitd::doctor {

Findings check_faults(const LogCase& log);     // what gaitd itself gave as the reason
Findings check_solver(const LogCase& log);     // whole-body problems that were not solved
Findings check_support(const LogCase& log);    // pushes; CoP on the edge of the feet
Findings check_torques(const LogCase& log);    // leg joints at their torque limits
Findings check_joints(const LogCase& log);     // leg joints at their position limits
Findings check_slip(const LogCase& log);       // feet that slide
Findings check_timing(const LogCase& log);     // late ticks, in real time
Findings check_estimate(const LogCase& log);   // IMU against legs, gravity and truth
Findings check_footsteps(const LogCase& log);  // footsteps out of reach
Findings check_weight(const LogCase& log);     // mass of the model against measured forces
Findings check_load(const LogCase& log);       // loads that a standing robot did not know of
Findings check_handholds(const LogCase& log);  // hands that were torn off what they held on to
Findings check_pull(const LogCase& log);       // steady forces that the robot leaned against

// "+x", "-y", "+x-y": the world axes that a horizontal vector is nearest to.
std::string direction(const Eigen::Vector2d& v);

// A finding of a log, at the tick where it began.
Finding log_finding(const LogCase& log, const char* check, std::size_t tick, std::string what,
                    std::string advice);

}  // namespace gaitd::doctor
