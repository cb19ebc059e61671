// SPDX-License-Identifier: Apache-2.0
#include "strides.h"

#include <cmath>
#include <iterator>

#include "step_costs.h"

namespace gaitd::footsteps {
namespace {

// Pelvis heights.
constexpr double kAhead[] = {-0.22, -0.11, 0.0, 0.11, 0.22, 0.33, 0.43, 0.54};
constexpr double kOutwards[] = {-0.02, 0.05, 0.13, 0.22};
constexpr double kInwardsToGoal = 0.02;  // nearer to the other foot than the least of these
constexpr double kLongestGoal = 0.45;    // of the steps to the goal itself

}  // namespace

std::vector<Stride> make_strides(double unit, double apart) {
  std::vector<Stride> strides;
  for (const double ahead : kAhead) {
    for (const double outwards : kOutwards) {
      for (int turn = -1; turn <= 2; ++turn) {
        // Long steps are straight ones.
        if (std::abs(ahead) > 0.4 && (turn != 0 || outwards > 0.15)) continue;
        if (std::abs(turn) > 1 && std::abs(ahead) > 0.25) continue;
        strides.push_back({ahead * unit, apart + outwards * unit, turn,
                           stride_cost(ahead, outwards, std::abs(turn))});
      }
    }
  }
  return strides;
}

bool is_goal_stride(double ahead, double outwards, double headings) {
  return ahead >= kAhead[0] && ahead <= kLongestGoal && outwards >= kOutwards[0] - kInwardsToGoal &&
         outwards <= std::end(kOutwards)[-1] && headings >= -1.2 && headings <= 2.2;
}

}  // namespace gaitd::footsteps
