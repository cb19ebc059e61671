// SPDX-License-Identifier: Apache-2.0
#include "map_planner.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"

namespace gaitd::footsteps {
namespace {

using walking::other_side;

constexpr double kAsideStep = 0.02;    // m, from one place that is looked at to the next
constexpr double kAsideCost = 40.0;    // steps per metre
constexpr double kSameHeight = 0.003;  // m, and
constexpr double kSameTilt = 0.01;     // rad: a foothold is where it was

void raise_region(double by, GaitdFootstep* step) {
  for (int i = 0; i < step->region_count; ++i) step->landing_region[i][2] += by;
}

bool changed(const GaitdFootstep& step, const GaitdFootstep& before) {
  return !same_foothold(step.pose, before.pose) || step.swing_height != before.swing_height;
}

}  // namespace

bool same_foothold(const GaitdPose& a, const GaitdPose& b) {
  return (sdk::view(a.position) - sdk::view(b.position)).norm() < kSameHeight &&
         sdk::quaternion(a.orientation).angularDistance(sdk::quaternion(b.orientation)) < kSameTilt;
}

const char* reason(FootholdState state) {
  switch (state) {
    case FootholdState::kUnknown:
      return "the ground is not known there";
    case FootholdState::kRough:
      return "the sole would not lie flat there";
    case FootholdState::kSteep:
      return "the ground is too steep there";
    default:
      return "a riser is in the way there";
  }
}

Plan MapPlanner::adapt(const Start& start, const std::vector<GaitdFootstep>& ahead,
                       const walking::GaitParameters& parameters) {
  Plan plan;
  GaitdPose feet[GAITD_MAX_FEET] = {start.feet[GAITD_LEFT], start.feet[GAITD_RIGHT]};
  steps_->set_level(start);
  for (const GaitdFootstep& old : ahead) {
    const Place place = place_of(old.pose);
    const Foothold foothold = steps_->footholds().at(old.side, place, walking::kMaxStepTilt);
    const char* why = foothold.state == FootholdState::kGood ? nullptr : reason(foothold.state);
    GaitdFootstep step;
    if (why == nullptr &&
        steps_->make(old.side, Footholds::pose_of(place, foothold), feet[other_side(old.side)],
                     feet[old.side], parameters, &step) != StepState::kGood) {
      why = "out of reach";
    }
    if (why != nullptr) {
      char text[160];
      std::snprintf(text, sizeof(text), "footstep at (%.2f, %.2f): %s", place.x, place.y, why);
      plan.refusal = text;
      break;
    }
    plan.cost += foothold.cost +
                 steps_->cost(step, feet[other_side(step.side)], feet[step.side], parameters);
    feet[step.side] = step.pose;
    plan.footsteps.push_back(step);
  }
  const std::string why = plan.refusal;
  steps_->finish(start, parameters, &plan);
  if (!why.empty()) plan.refusal = why;
  return plan;
}

bool MapPlanner::put_on_ground(const GaitdPose& stance, const GaitdPose& from,
                               const walking::GaitParameters& parameters,
                               GaitdFootstep* step) const {
  const Place wanted = place_of(step->pose);
  const double c = std::cos(wanted.yaw), s = std::sin(wanted.yaw);
  const int reach = static_cast<int>(std::lround(kAside / kAsideStep));
  // Whoever sent it may know more of what is around than the map.
  const walking::ConvexPolygon region =
      step->region_told != 0 ? walking::landing_region(*step) : walking::ConvexPolygon{};
  double least = std::numeric_limits<double>::infinity();
  GaitdFootstep best;
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -reach; j <= reach; ++j) {
      const double ahead = kAsideStep * i, left = kAsideStep * j;
      const double cost = kAsideCost * std::hypot(ahead, left);
      if (cost >= least || std::hypot(ahead, left) > kAside + 1e-9) continue;
      const Place place{wanted.x + c * ahead - s * left, wanted.y + s * ahead + c * left,
                        wanted.yaw};
      if (region.size() > 2 && region.inside_distance({place.x, place.y}) < -1e-6) continue;
      const Foothold foothold = steps_->footholds().at(step->side, place, walking::kMaxStepTilt);
      if (foothold.state == FootholdState::kUnknown && i == 0 && j == 0) return false;
      if (foothold.state != FootholdState::kGood || cost + foothold.cost >= least) continue;
      GaitdFootstep candidate = *step;
      candidate.pose = Footholds::pose_of(place, foothold);
      if (steps_->rules().check(candidate, stance, from, 1, parameters).refused()) continue;
      least = cost + foothold.cost;
      best = candidate;
    }
  }
  if (!std::isfinite(least)) return false;
  *step = best;
  return true;
}

std::vector<GaitdFootstep> MapPlanner::refine(const Start& start,
                                              const std::vector<GaitdFootstep>& ahead,
                                              const walking::GaitParameters& parameters) {
  std::vector<GaitdFootstep> refined = ahead;
  if (!steps_->footholds().has_map()) return {};
  GaitdPose feet[GAITD_MAX_FEET] = {start.feet[GAITD_LEFT], start.feet[GAITD_RIGHT]};
  double raised = 0.0;  // m, by the ground below the footsteps before
  for (GaitdFootstep& step : refined) {
    const GaitdFootstep before = step;
    const GaitdPose& stance = feet[other_side(step.side)];
    const GaitdPose& from = feet[step.side];
    if (put_on_ground(stance, from, parameters, &step)) {
      raised = step.pose.position[2] - before.pose.position[2];
      // A foot that strikes something all the same goes as high as it was told to.
      static_cast<void>(steps_->raise_swing(stance, from, parameters, &step));
      if (!changed(step, before)) {
        step = before;
      } else if (step.region_told != 0) {
        raise_region(raised, &step);
      } else {
        steps_->footholds().add_landing_region(&step);
      }
    } else {  // level with those before, not where blind footsteps would be
      step.pose.position[2] += raised;
      raise_region(raised, &step);
    }
    feet[step.side] = step.pose;
  }
  // Longer transfers where heights ask for them. Where that is not enough, those behind are left as
  // they were.
  for (std::size_t kept = refined.size(); kept > 0; --kept) {
    if (kept < refined.size()) refined[kept] = ahead[kept];
    std::vector<GaitdFootstep> steps = refined;
    if (steps_->rules().finish(start, parameters, &steps).refused()) continue;
    std::vector<GaitdFootstep> result;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      if (changed(steps[i], ahead[i]) || steps[i].transfer_duration != ahead[i].transfer_duration) {
        result.push_back(steps[i]);
      }
    }
    return result;
  }
  return {};
}

std::optional<double> MapPlanner::ground_below(int side, const GaitdPose& sole) const {
  if (!steps_->footholds().has_map()) return std::nullopt;
  return steps_->footholds().below(side, sole);
}

}  // namespace gaitd::footsteps
