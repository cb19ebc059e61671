// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gaitd/abi/plugin.h"

namespace gaitd::daemon {

// How far the outputs of two variants of a layer are apart, in what two sound ones may be: above 1
// something is wrong with one of them. [rt]
double output_difference(const GaitdModel& model, const GaitdRobotState& a,
                         const GaitdRobotState& b);
double output_difference(const GaitdModel& model, const GaitdIcpPlan& a, const GaitdIcpPlan& b);
double output_difference(const GaitdModel& model, const GaitdStepAdjustment& a,
                         const GaitdStepAdjustment& b);
double output_difference(const GaitdModel& model, const GaitdToeOff& a, const GaitdToeOff& b);
double output_difference(const GaitdModel& model, const GaitdWholeBodyControllerOutput& a,
                         const GaitdWholeBodyControllerOutput& b);
double output_difference(const GaitdModel& model, const GaitdTaskReferences& a,
                         const GaitdTaskReferences& b);

// Cross-fades what acts on the robot at once: `to` becomes the mix of both, with `share` (0..1) of
// its own. Outputs that carry their continuity in the state of the layer stay as they are. [rt]
void cross_fade(const GaitdIcpPlan& from, double share, GaitdIcpPlan& to);
void cross_fade(const GaitdStepAdjustment& from, double share, GaitdStepAdjustment& to);
void cross_fade(const GaitdWholeBodyControllerOutput& from, double share,
                GaitdWholeBodyControllerOutput& to);
void cross_fade(const GaitdTaskReferences& from, double share, GaitdTaskReferences& to);
template <class Output>
void cross_fade(const Output&, double, Output&) {}

// Whether the layer may be exchanged between this tick and the next. [rt]
inline bool may_switch(const GaitdToeOff& toe_off) { return toe_off.active == 0; }
template <class Output>
bool may_switch(const Output&) {
  return true;
}

}  // namespace gaitd::daemon
