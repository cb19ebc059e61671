// SPDX-License-Identifier: Apache-2.0
#include "goal_place.h"

#include <cmath>
#include <cstdio>
#include <limits>

#include "gaitd/walking/support.h"

namespace gaitd::footsteps {
namespace {

constexpr double kReach = 0.15;  // m, by which the feet may be beside the goal

}  // namespace

Place sole_beside(const Place& middle, int side, const GaitdModel& model) {
  const double y = 0.5 * model.nominal_foot_separation * walking::side_sign(side);
  return {middle.x - std::sin(middle.yaw) * y, middle.y + std::cos(middle.yaw) * y, middle.yaw};
}

GoalPlace find_goal_place(const StepMaker& steps, const Place& wanted, double cell) {
  GoalPlace goal;
  goal.middle = wanted;
  const int reach = static_cast<int>(kReach / cell);
  double nearest = std::numeric_limits<double>::infinity();
  bool unknown = false;
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -reach; j <= reach; ++j) {
      const double distance = cell * std::hypot(i, j);
      if (distance > kReach || distance >= nearest) continue;
      const Place middle{wanted.x + cell * i, wanted.y + cell * j, wanted.yaw};
      const auto look = [&](int side) {
        return steps.footholds().at(side, sole_beside(middle, side, steps.model()),
                                    walking::kMaxStepTilt);
      };
      const Foothold left = look(GAITD_LEFT), right = look(GAITD_RIGHT);
      const bool good = left.state == FootholdState::kGood && right.state == FootholdState::kGood;
      unknown = unknown || left.state == FootholdState::kUnknown ||
                right.state == FootholdState::kUnknown;
      if (i == 0 && j == 0) {
        goal.problem = left.state != FootholdState::kGood ? left.state : right.state;
      }
      if (!good || std::abs(left.z - right.z) > steps.highest_step()) continue;
      nearest = distance;
      goal.middle = middle;
      goal.footholds = {left, right};
      goal.found = true;
    }
  }
  if (!goal.found && unknown) goal.problem = FootholdState::kUnknown;
  return goal;
}

std::string no_goal_place(const Place& wanted, FootholdState problem) {
  char text[200];
  std::snprintf(text, sizeof(text),
                "no foothold within %.2f m of the goal (%.2f, %.2f): the ground there is %s",
                kReach, wanted.x, wanted.y,
                problem == FootholdState::kUnknown   ? "not known"
                : problem == FootholdState::kSteep   ? "too steep"
                : problem == FootholdState::kBlocked ? "beside a riser"
                                                     : "not flat enough for a sole");
  return text;
}

}  // namespace gaitd::footsteps
