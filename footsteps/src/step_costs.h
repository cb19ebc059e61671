// SPDX-License-Identifier: Apache-2.0
// What steps cost, in steps on level ground that are hardly longer than nothing: effort and risk.
#ifndef GAITD_FOOTSTEPS_STEP_COSTS_H_
#define GAITD_FOOTSTEPS_STEP_COSTS_H_

#include <cmath>

#include "angle.h"
#include "gaitd/abi/types.h"
#include "gaitd/sdk/views.h"
#include "gaitd/walking/footsteps.h"

namespace gaitd::footsteps {

inline constexpr int kHeadings = 24;  // of a turn
inline constexpr double kHeading = 2.0 * M_PI / kHeadings;

// Of a stride: ahead of the other foot and outwards beyond their distance in the nominal posture,
// pelvis heights; turned by so many headings.
inline double stride_cost(double ahead, double outwards, double headings) {
  return 1.0 + 1.5 * ahead * ahead + 20.0 * outwards * outwards + 0.15 * headings +
         (ahead < 0.0 ? 0.3 : 0.0);
}

// Of a foothold above or below the other one, pelvis heights.
inline double height_cost(double height) { return 10.0 * height * height; }

// Of a slow swing, over what is not level, beside that: for its time, and for its way, what of it
// is to the side, its turn, its rise and its raised apex. `unit`: m, a pelvis height.
inline double swing_cost(const GaitdFootstep& step, const GaitdPose& from, double unit,
                         const walking::GaitParameters& parameters) {
  using walking::Gait;
  if (step.swing_duration <= parameters[Gait::kSwingDuration]) return 0.0;
  const Eigen::Vector3d way = (sdk::view(step.pose.position) - sdk::view(from.position)) / unit;
  const double raised = (step.swing_height - parameters[Gait::kSwingHeight]) / unit;
  const double yaw = sdk::yaw_of(sdk::quaternion(from.orientation));
  const double aside = std::cos(yaw) * way.y() - std::sin(yaw) * way.x();
  const double turn = wrapped(sdk::yaw_of(sdk::quaternion(step.pose.orientation)) - yaw);
  return 0.5 + 2.5 * way.head<2>().squaredNorm() + 12.0 * aside * aside + 6.0 * turn * turn +
         6.0 * way.z() * way.z() + 8.0 * raised;
}

}  // namespace gaitd::footsteps

#endif  // GAITD_FOOTSTEPS_STEP_COSTS_H_
