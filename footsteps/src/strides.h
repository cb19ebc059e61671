// SPDX-License-Identifier: Apache-2.0
// The steps of a search: from one foot to where the other one may step.
#ifndef GAITD_FOOTSTEPS_STRIDES_H_
#define GAITD_FOOTSTEPS_STRIDES_H_

#include <vector>

namespace gaitd::footsteps {

// In the frame of the first foot as if it were the right one: outwards is to the left.
struct Stride {
  double ahead, outwards;  // m
  int turn;                // headings (kHeading), outwards
  double cost;             // steps
};

// `unit`: m, height of the pelvis; `apart`: m, between the feet in the nominal posture.
std::vector<Stride> make_strides(double unit, double apart);

// Whether a stride to the goal itself is one of these, or between them. Ahead, and outwards beyond
// the distance of the feet in the nominal posture, in pelvis heights; turned outwards by so many
// headings.
bool is_goal_stride(double ahead, double outwards, double headings);

}  // namespace gaitd::footsteps

#endif  // GAITD_FOOTSTEPS_STRIDES_H_
