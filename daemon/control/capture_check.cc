// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/capture_check.h"

#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"

namespace gaitd::daemon {

using P = SafetyParameter;

bool CaptureCheck::lost(double dt, const GaitdRobotState& robot, const GaitdGaitState& gait,
                        const sdk::Parameters<SafetyParameter>& p) {
  const walking::ConvexPolygon feet = walking::support_region(model_, gait, robot);
  const double reach = p[P::kCaptureReach] * model_.nominal_com_height;
  if (feet.empty() || gait.omega <= 0.0) {
    reset();
    return false;
  }
  distance_ = -feet.inside_distance(sdk::view(robot.icp));
  const double swing = gait.phase == GAITD_PHASE_SWING ? gait.time_remaining : 0.0;
  const double step_time = kStepTime * std::sqrt(model_.nominal_com_height / model_.gravity);
  limit_ = reach / (1.0 - std::exp(-gait.omega * step_time)) * std::exp(-gait.omega * swing);
  time_beyond_ = distance_ > limit_ ? time_beyond_ + dt : 0.0;
  return time_beyond_ > kPatience;
}

}  // namespace gaitd::daemon
