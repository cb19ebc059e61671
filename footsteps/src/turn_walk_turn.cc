// SPDX-License-Identifier: Apache-2.0
#include "turn_walk_turn.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include "angle.h"
#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"

namespace gaitd::footsteps {
namespace {

using walking::Gait;
using walking::other_side;
using walking::side_sign;

constexpr double kLargestTurn = 0.35;  // rad, from one footstep to the next
constexpr double kNoWay = 1e-3;        // m, or rad
constexpr int kMostSteps = 900;        // fewer than the queue of the gait machine holds

// From one footstep to the next, of the middle of the feet.
struct Motion {
  double ahead, beside;  // m
  double turn;           // rad
  int count;
};

int count_of(double way, double each) {
  return std::abs(way) < kNoWay ? 0 : static_cast<int>(std::ceil(std::abs(way) / each - 1e-9));
}

}  // namespace

Plan TurnWalkTurn::walk(const Start& start, const Goal& goal, const Manner& manner,
                        const walking::GaitParameters& parameters) const {
  Plan plan;
  const Place from = middle_of(start.feet[GAITD_LEFT], start.feet[GAITD_RIGHT]);
  const double dx = goal.x - from.x, dy = goal.y - from.y;
  const double way = std::hypot(dx, dy);
  const bool walks = way > kNoWay;
  const double heading = walks ? std::atan2(dy, dx) - manner.angle : goal.yaw.value_or(from.yaw);
  const double first_turn = wrapped(heading - from.yaw);
  const double last_turn = wrapped(goal.yaw.value_or(heading) - heading);
  const int strides = walks ? count_of(way, manner.stride * steps_->unit()) : 0;
  const double each = strides > 0 ? way / strides : 0.0;
  const double lateral = each * std::sin(manner.angle);
  std::vector<Motion> motions;
  const auto add = [&motions](double ahead, double beside, double turn, int count) {
    if (count > 0) motions.push_back({ahead, beside, turn / count, count});
  };
  add(0, 0, first_turn, count_of(first_turn, kLargestTurn));
  add(each * std::cos(manner.angle), lateral, 0, strides);
  add(0, 0, last_turn, count_of(last_turn, kLargestTurn));
  if (motions.empty()) return plan;

  int side = start.first_side;
  if (side == GAITD_BOTH) {  // to the side it goes to, so that the legs never close first
    const Motion& m = motions.front();
    side = m.beside > kNoWay || (std::abs(m.beside) <= kNoWay && m.turn > 0) ? GAITD_LEFT
                                                                             : GAITD_RIGHT;
  }
  const double least = walking::StepLimits(steps_->model(), parameters).least_separation;
  const double width = std::max(steps_->model().nominal_foot_separation, least + std::abs(lateral));
  GaitdPose feet[GAITD_MAX_FEET] = {start.feet[GAITD_LEFT], start.feet[GAITD_RIGHT]};
  Place at = from;
  const auto step_to = [&](double apart) {
    const int number = static_cast<int>(plan.footsteps.size()) + 1;
    const double y = 0.5 * apart * side_sign(side);
    const Place place{at.x - std::sin(at.yaw) * y, at.y + std::cos(at.yaw) * y, at.yaw};
    const Foothold foothold = steps_->footholds().at(side, place, walking::kMaxStepTilt);
    char text[160];
    if (foothold.state != FootholdState::kGood) {
      std::snprintf(text, sizeof(text), "footstep %d at (%.2f, %.2f): %s", number, place.x, place.y,
                    reason(foothold.state));
      plan.refusal = text;
      return false;
    }
    GaitdFootstep step;
    const StepState state = steps_->make(side, Footholds::pose_of(place, foothold),
                                         feet[other_side(side)], feet[side], parameters, &step);
    if (state != StepState::kGood) {
      std::snprintf(text, sizeof(text), "footstep %d at (%.2f, %.2f): out of reach", number,
                    place.x, place.y);
      plan.refusal = text;
      return false;
    }
    plan.cost += foothold.cost + steps_->cost(step, feet[other_side(side)], feet[side], parameters);
    feet[side] = step.pose;
    plan.footsteps.push_back(step);
    side = other_side(side);
    return true;
  };
  for (const Motion& m : motions) {
    for (int i = 0; i < m.count; ++i) {
      at.x += std::cos(at.yaw) * m.ahead - std::sin(at.yaw) * m.beside;
      at.y += std::sin(at.yaw) * m.ahead + std::cos(at.yaw) * m.beside;
      at.yaw += m.turn;
      if (plan.footsteps.size() >= kMostSteps) {
        plan.refusal = "more than 900 footsteps away; go there in parts";
        return plan;
      }
      if (!step_to(width)) return plan;
    }
  }
  at = {goal.x, goal.y, wrapped(heading + last_turn)};
  if (!walks) at = {from.x, from.y, at.yaw};
  // Side by side as it stands; after wide steps the foot before has to come in as well.
  if (step_to(steps_->model().nominal_foot_separation) &&
      width > steps_->model().nominal_foot_separation + kNoWay) {
    step_to(steps_->model().nominal_foot_separation);
  }
  return plan;
}

Plan TurnWalkTurn::plan(const Start& start, const Goal& goal,
                        const walking::GaitParameters& parameters) {
  constexpr Manner kManners[] = {{0.0, 0.38}, {M_PI, 0.2}, {M_PI_2, 0.15}, {-M_PI_2, 0.15}};
  steps_->set_level(start);
  std::optional<Plan> best;
  std::string why;
  for (const Manner& manner : kManners) {
    Plan plan = walk(start, goal, manner, parameters);
    if (plan.refusal.empty()) steps_->finish(start, parameters, &plan);
    if (!plan.refusal.empty()) {
      if (why.empty()) why = plan.refusal;  // of walking forwards
    } else if (!best || plan.footsteps.size() < best->footsteps.size()) {
      best = std::move(plan);
    }
  }
  if (best) return *best;
  Plan none;
  none.refusal = "no way straight to the goal: " + why;
  return none;
}

}  // namespace gaitd::footsteps
