// SPDX-License-Identifier: Apache-2.0
#include "heel_to_toe.h"

namespace gaitd::plugins {
namespace {

// Heights of the CoM: a step from which on the whole of exit_x is used, and how far the CMPs stay
// inside the foothold.
constexpr double kExitStepLength = 0.1699;
constexpr double kMargin = 0.01274;

}  // namespace

HeelToToe::HeelToToe(const GaitdModel& model) : scale_(model), reference_(model) {}

GaitdStatus HeelToToe::process(const GaitdIcpPlannerInput& in, GaitdIcpPlan& out) {
  const walking::CmpOffsets offsets{.entry_x = p_[P::kEntryX],
                                    .entry_y = p_[P::kEntryY],
                                    .exit_x = p_[P::kExitX],
                                    .exit_y = p_[P::kExitY],
                                    .exit_x_step_length = kExitStepLength * scale_.length,
                                    .margin = kMargin * scale_.length};
  reference_.update(in.time.period, *in.robot, *in.gait, offsets, out);
  return GAITD_OK;
}

}  // namespace gaitd::plugins
