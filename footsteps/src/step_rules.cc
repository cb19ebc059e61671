// SPDX-License-Identifier: Apache-2.0
#include "gaitd/footsteps/step_rules.h"

#include <algorithm>
#include <array>

#include "gaitd/walking/support.h"

namespace gaitd::footsteps {
namespace {

using walking::CaptureCheck;
using walking::GaitParameters;
using walking::Refusal;

constexpr double kTransferStep = 0.05;    // s
constexpr double kLongestTransfer = 1.0;  // s

}  // namespace

StepRules::StepRules(const GaitdModel& model)
    : model_(model), step_check_(model), capture_check_(model) {}

Refusal StepRules::check(const GaitdFootstep& step, const GaitdPose& stance, const GaitdPose& from,
                         int number, const GaitParameters& parameters) const {
  return step_check_.check(step, stance, from, number, parameters);
}

// For the footstep after the one that lands. False: no transfer is long enough.
bool StepRules::give_time(const Start& start, std::size_t landing,
                          std::vector<GaitdFootstep>* all) const {
  const std::size_t known = std::min(std::size_t{CaptureCheck::kAhead}, all->size() - landing);
  std::array<GaitdFootstep, CaptureCheck::kAhead> ahead;
  std::copy_n(all->begin() + static_cast<std::ptrdiff_t>(landing), known, ahead.begin());
  const int stands = walking::other_side(ahead[0].side);
  GaitdFoothold stance = landing > 0 ? walking::foothold_of(model_, (*all)[landing - 1])
                                     : walking::whole_sole(model_, stands, start.feet[stands]);
  stance.contact = GAITD_CONTACT_FULL;
  for (double& transfer = ahead[1].transfer_duration;; transfer += kTransferStep) {
    const CaptureCheck::Room room = capture_check_.room(
        stance, ahead.data(), static_cast<int>(known), walking::kFinalTransfer, start.omega);
    if (room.capture >= room.error) break;
    if (transfer > kLongestTransfer) return false;
  }
  (*all)[landing + 1].transfer_duration = ahead[1].transfer_duration;
  return true;
}

Refusal StepRules::finish(const Start& start, const GaitParameters& parameters,
                          std::vector<GaitdFootstep>* footsteps) const {
  GaitdPose feet[GAITD_MAX_FEET] = {start.feet[GAITD_LEFT], start.feet[GAITD_RIGHT]};
  for (std::size_t i = 0; i < footsteps->size(); ++i) {
    const GaitdFootstep& step = (*footsteps)[i];
    const int number = static_cast<int>(i) + 1;
    if (Refusal r =
            check(step, feet[walking::other_side(step.side)], feet[step.side], number, parameters);
        r.refused()) {
      return r;
    }
    feet[step.side] = step.pose;
  }
  std::vector<GaitdFootstep> all;
  if (start.under_way) all.push_back(*start.under_way);
  const std::size_t before = all.size();
  all.insert(all.end(), footsteps->begin(), footsteps->end());
  // A longer transfer moves the plan of the steps before it too: from the last one back, and again.
  for (int round = 0; round < 2; ++round) {
    for (std::size_t i = all.size(); i-- > 1;) {
      if (!give_time(start, i - 1, &all)) {
        return walking::refuse("footstep %d: no transfer is long enough for it",
                               static_cast<int>(i + 1 - before));
      }
    }
  }
  footsteps->assign(all.begin() + static_cast<std::ptrdiff_t>(before), all.end());
  return {};
}

}  // namespace gaitd::footsteps
