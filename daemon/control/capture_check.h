// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "daemon/parameters/safety_parameters.h"
#include "gaitd/abi/plugin.h"
#include "gaitd/abi/types.h"

namespace gaitd::daemon {

// Whether the robot can still be caught: a fall is known long before the pelvis is low. Steps of at
// most L (m), at least T (s) apart, catch an ICP whose distance from the foothold of the first one
// is
//   L (1 + q + q^2 + ...) - L,  q = exp(-w T)
// and until that one lands its distance from the feet grows as exp(w t). Beyond the limit
//   L / (1 - q) exp(-w t),  t the time to touchdown
// no sequence of steps catches it, whatever their direction.
class CaptureCheck {
 public:
  static constexpr double kStepTime = 1.44;  // sqrt(h / g), T above: 0.5 s for Atlas
  static constexpr double kPatience = 0.02;  // s: noise of the velocity is shorter

  explicit CaptureCheck(const GaitdModel& model) : model_(model) {}
  void reset() { time_beyond_ = 0.0; }

  // True once the ICP has been beyond the limit for kPatience. A robot that stands on
  // nothing, and one whose gait has no natural frequency yet, is not judged.
  bool lost(double dt, const GaitdRobotState& robot, const GaitdGaitState& gait,
            const sdk::Parameters<SafetyParameter>& parameters);

  // Of the last call: how far the ICP was outside the feet, and the limit (m).
  double distance() const { return distance_; }
  double limit() const { return limit_; }

 private:
  const GaitdModel& model_;
  double time_beyond_ = 0.0;
  double distance_ = 0.0;
  double limit_ = 0.0;
};

}  // namespace gaitd::daemon
