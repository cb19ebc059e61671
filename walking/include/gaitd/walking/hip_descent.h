// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "gaitd/walking/swing_trajectory.h"

namespace gaitd::walking {

// The leg in swing, and how its hip goes on over the foot that stands, as a linear inverted
// pendulum.
struct SwingLeg {
  Eigen::Vector3d hip;            // m, W
  Eigen::Vector3d ankle_in_sole;  // m, sole frame, of a level foot
  double longest;                 // m, hip to ankle, when it lands on level ground
  double longest_down;            // m, the same on ground a good deal lower
  double ground;                  // m, W: under the foot that stands
  Eigen::Vector2d lever;          // m, W: CoM from the foot that stands
  Eigen::Vector2d velocity;       // m/s, W, of the CoM
  double omega;                   // 1/s, of the pendulum
  double gravity;                 // m/s^2
};

// m, W: how high the hip may be `now` (s in the swing, due to end at `duration`) so that it is low
// enough all the way until the foot is down, if it comes down gently and begins in time. Whoever
// follows this height lets the leg reach its foothold, also one that is late or lower than planned.
double highest_hip(const SwingTrajectory& swing, double now, double duration, const SwingLeg& leg);

// The leg that trails in a transfer.
struct TrailingLeg {
  Eigen::Vector3d hip;       // m, W, now
  Eigen::Vector3d ankle;     // m, W
  Eigen::Vector2d heading;   // W, of its foot
  double flat;               // m, of the hip ahead of the ankle: the heel comes up for what is more
  double longest;            // m, hip to ankle
  Eigen::Vector2d lever;     // m, W: CoM from the foot that stands alone until the transfer begins
  Eigen::Vector2d velocity;  // m/s, W, of the CoM
  double swing;              // s until the transfer begins
  double transfer;           // s that it lasts, or is left of it
  double omega;              // 1/s, of the pendulum of the swing
  double gravity;            // m/s^2
};

// m, W: how high the hip may be now for that leg to reach its foothold until it lifts off.
double highest_hip(const TrailingLeg& leg);

}  // namespace gaitd::walking
