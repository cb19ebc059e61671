// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/robot/guess.h"

namespace gaitd::porting {

// Two chains of a tree that mirror each other, from the body that carries both.
struct LegPair {
  int pelvis = 0;                          // body
  std::array<std::vector<int>, 2> joints;  // in the order of the chain; which is left is not known
};

// The pair of chains that is most likely to be the legs: mirror images of five joints or more,
// heavy and long, ended by what no other joint hangs on; what the joints are called counts for
// little. False and why in `error` without one.
bool find_legs(const GaitdModel& model, LegPair* pair, std::string* error);

// Joints beyond the ankle, which carry toes: those that the model shall have fixed.
std::vector<int> find_toes(const GaitdModel& model, const LegPair& pair);

// Axes of the robot (x forward, y left, z up) in those of the pelvis body, as columns, from where
// the feet hang, how they lie under the ankles and how the knees bend. Says why. `left` is the
// index in `pair` of the left leg.
Eigen::Matrix3d find_directions(const GaitdModel& model, const LegPair& pair,
                                const std::array<std::vector<Eigen::Vector3d>, 2>& foot_points,
                                int* left, Reasons* why);

// The joints that pitch at hip, knee and ankle, and the one that rolls at the ankle, of a leg in a
// model whose pelvis looks along x. False and why in `error` without them.
bool find_roles(const GaitdModel& model, LegGuess* leg, std::string* error);

}  // namespace gaitd::porting
