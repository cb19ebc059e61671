// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gaitd/abi/plugin.h"

namespace gaitd::daemon {

// Everything that the layers read in one tick.
struct InputSet {
  GaitdLayerTime time{};
  GaitdSensors sensors{};
  GaitdGaitState gait_before{};  // of the tick before: what the estimator sees
  GaitdJointCommands commands{};
  GaitdRobotState robot{};
  GaitdGaitState gait{};
  GaitdIcpPlan plan{};
  GaitdStepAdjustment adjustment{};
  GaitdToeOff toe_off{};
  GaitdObjectives objectives{};
  GaitdMotions motions{};

  // The input of one layer; it points into this object.
  GaitdStateEstimatorInput estimator() const;
  GaitdIcpPlannerInput planner() const;
  GaitdStepAdjusterInput adjuster() const;
  GaitdToeOffInput toe_off_input() const;
  GaitdWholeBodyControllerInput controller() const;
  GaitdTaskSourceInput task_source() const;

  // Puts `value` where a sensor or a layer before could have left a number that is none. Counts,
  // indices and durations stay: the daemon makes those.
  void spoil(double value);
};

// The input of layer number kLayer.
template <int kLayer>
auto input_of(const InputSet& set) {
  if constexpr (kLayer == GAITD_LAYER_STATE_ESTIMATOR) return set.estimator();
  if constexpr (kLayer == GAITD_LAYER_ICP_PLANNER) return set.planner();
  if constexpr (kLayer == GAITD_LAYER_STEP_ADJUSTER) return set.adjuster();
  if constexpr (kLayer == GAITD_LAYER_TOE_OFF) return set.toe_off_input();
  if constexpr (kLayer == GAITD_LAYER_WHOLE_BODY_CONTROLLER) return set.controller();
  if constexpr (kLayer == GAITD_LAYER_TASK_SOURCE) return set.task_source();
}

}  // namespace gaitd::daemon
