// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "random_problem.h"
#include "recorded_ticks.h"

namespace gaitd::benchmarks {

// Consecutive quadratic programs, with how many of the rows of C are limits of joint torques.
using QpSequence = std::vector<qp::testing::OwnedProblem>;

// The given sequences: double_support, single_support, toe_off (qp/test/data).
QpSequence recorded_problems(const std::string& name);
// What nullspace_qp makes of a recorded walk, with a share `torque_scale` of the effort limits.
QpSequence walk_problems(const std::string& walk, double torque_scale = 1.0);

// Leaves `scale` of the range between the torque limits of each joint.
void scale_torque_limits(double scale, QpSequence* problems);
// The largest scale, in steps of 5 %, at which a joint torque is at its limit in each problem on
// average; 0 if there is none that can be solved.
double binding_scale(const QpSequence& problems);

inline constexpr qp::Dimensions kMaxProblem{100, 6, 31};

}  // namespace gaitd::benchmarks
