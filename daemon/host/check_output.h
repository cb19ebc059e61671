// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gaitd/abi/plugin.h"

namespace gaitd::daemon {

// What is wrong with the output that a layer wrote for a robot of `joint_count` joints: a text that
// names the field and the rule, null if nothing. Checked are the size, that every number that
// somebody reads is finite, and the range of counts, enumerations and quaternions. The same check
// in the running daemon and in `gaitctl plugin check`. Real-time safe: no allocation.
const char* output_error(const GaitdRobotState& robot, int joint_count);
const char* output_error(const GaitdIcpPlan& plan, int joint_count);
const char* output_error(const GaitdStepAdjustment& adjustment, int joint_count);
const char* output_error(const GaitdToeOff& toe_off, int joint_count);
const char* output_error(const GaitdWholeBodyControllerOutput& wbc, int joint_count);
const char* output_error(const GaitdTaskReferences& references, int joint_count);

}  // namespace gaitd::daemon
