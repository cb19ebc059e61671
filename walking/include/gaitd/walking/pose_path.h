// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "gaitd/walking/minimum_jerk_path.h"

namespace gaitd::walking {

// A minimum-jerk way through poses. Orientations go by their rotation vector from the first one,
// the short way from each point to the next.
class PosePath {
 public:
  struct Sample {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  // m
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
    Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
    Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  // rad/s, axes of the parent
    Eigen::Vector3d angular_acceleration = Eigen::Vector3d::Zero();
  };

  // From `start` through the points of `motion` that come after `elapsed` (s, since the motion
  // began), axes 0 to 5 as the motion says; those not in its mask stay at `start`.
  void begin(const Sample& start, const GaitdMotion& motion, double elapsed);
  Sample at(double t) const;  // s, since begin()
  double duration() const { return path_.duration(); }

 private:
  MinimumJerkPath path_;
  Eigen::Quaterniond start_ = Eigen::Quaterniond::Identity();
};

}  // namespace gaitd::walking
