// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "gaitd/abi/types.h"

namespace gaitd::walking {

// The way through given values at given times, from a state to rest, with the least integral of the
// squared jerk: quintics between the points, continuous up to the fourth derivative (Flash and
// Hogan 1985; for several points a spline). A way that is begun again anywhere on it, through the
// points that are left, is the same way.
class MinimumJerkPath {
 public:
  static constexpr int kMaxAxes = GAITD_MAX_MOTION_AXES;
  static constexpr int kMaxPoints = GAITD_MAX_MOTION_POINTS;
  using Axes = Eigen::Matrix<double, kMaxAxes, 1>;  // unit of the axis

  struct Sample {
    Axes value = Axes::Zero();
    Axes velocity = Axes::Zero();      // 1/s
    Axes acceleration = Axes::Zero();  // 1/s^2
  };

  // From `start` at time 0. `times` (s) increase from above 0; `count` is 0 to kMaxPoints, with
  // none it stays at the value of `start`.
  void begin(const Sample& start, const double* times, const Axes* values, int count);
  // At time t (s), >= 0; after the last point at rest there.
  Sample at(double t) const;
  double duration() const { return times_[count_]; }

 private:
  std::array<double, kMaxPoints + 1> times_{};
  std::array<Sample, kMaxPoints + 1> knots_{};
  int count_ = 0;
};

}  // namespace gaitd::walking
