// SPDX-License-Identifier: Apache-2.0
#include "sole_table.h"

#include <algorithm>
#include <cmath>

#include "angle.h"
#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"
#include "step_costs.h"

namespace gaitd::footsteps {
namespace {

std::uint64_t key_of(int side, int i, int j, int heading) {
  return (static_cast<std::uint64_t>(i + (1 << 24)) << 32) ^
         (static_cast<std::uint64_t>(j + (1 << 24)) << 6) ^
         static_cast<std::uint64_t>(heading << 1 | side);
}

}  // namespace

SoleTable::SoleTable(const StepMaker& steps, const WayEstimate* way, double per_metre, double cell,
                     const Start& start, const GoalPlace& goal)
    : steps_(steps), way_(way), per_metre_(per_metre), cell_(cell), middle_(goal.middle) {
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const auto k = static_cast<std::size_t>(side);
    goal_[k].side = start_[k].side = side;
    goal_[k].place = sole_beside(middle_, side, steps_.model());
    goal_[k].foothold = goal.footholds[k];
    const GaitdPose& foot = start.feet[side];
    start_[k].place = {foot.position[0], foot.position[1],
                       sdk::yaw_of(sdk::quaternion(foot.orientation))};
    start_[k].foothold.z = foot.position[2];
    weigh(&goal_[k]);
    weigh(&start_[k]);
  }
}

SolePlace& SoleTable::nearest(int side, const Place& place) {
  const int i = static_cast<int>(std::lround((place.x - middle_.x) / cell_));
  const int j = static_cast<int>(std::lround((place.y - middle_.y) / cell_));
  int heading = static_cast<int>(std::lround((place.yaw - middle_.yaw) / kHeading)) % kHeadings;
  if (heading < 0) heading += kHeadings;
  const auto [entry, fresh] = lattice_.try_emplace(key_of(side, i, j, heading));
  SolePlace& sole = entry->second;
  if (fresh) {
    sole.side = side;
    sole.place = {middle_.x + cell_ * i, middle_.y + cell_ * j,
                  wrapped(middle_.yaw + heading * kHeading)};
    sole.foothold = steps_.footholds().at(side, sole.place, walking::kMaxStepTilt);
    // Where there is no foothold, nobody asks how far it is from there.
    if (sole.foothold.state <= FootholdState::kUnknown) weigh(&sole);
  }
  return sole;
}

void SoleTable::weigh(SolePlace* sole) const {
  const Place& p = sole->place;
  if (way_) {
    const Place middle = sole_beside(p, walking::other_side(sole->side), steps_.model());
    sole->way = way_->from({middle.x, middle.y});
  }
  const Place& end = goal_[static_cast<std::size_t>(sole->side)].place;
  const double distance = std::hypot(end.x - p.x, end.y - p.y);
  const double turn = std::abs(wrapped(end.yaw - p.yaw));
  // Each step takes one foot on, past the other one; the turn goes on meanwhile.
  sole->estimate = std::max({per_metre_ * distance, sole->way, turn / (1.5 * kHeading)});
}

}  // namespace gaitd::footsteps
