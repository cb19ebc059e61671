// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/step_check.h"

#include "gaitd/walking/foothold_check.h"

namespace gaitd::walking {

StepCheck::StepCheck(const GaitdModel& model)
    : model_(model), turn_reach_(model), swing_limits_(model) {}

Refusal StepCheck::check(const GaitdFootstep& step, const GaitdPose& stance, const GaitdPose& from,
                         int number, const GaitParameters& parameters) const {
  const StepLimits limits(model_, parameters);
  Refusal r = check_footstep(step, stance, from, number, limits);
  if (!r.refused()) r = turn_reach_.check(step, stance, number);
  if (!r.refused()) r = check_contact_polygon(model_, step, number);
  if (!r.refused()) r = check_straddle(step, stance, from, number, limits);
  if (!r.refused()) r = check_stride(step, stance, from, number, limits);
  if (!r.refused()) r = swing_limits_.check(step, stance, from, number);
  return r;
}

}  // namespace gaitd::walking
