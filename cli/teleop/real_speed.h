// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>

#include "cli/teleop/motion.h"

namespace gaitd::cli::teleop {

/// How fast the robot goes, from where its pelvis was: over the last second and a half, so that the
/// sway of single steps is not in it.
class RealSpeed {
 public:
  /// `time`: s, of gaitd; x, y: m and yaw: rad, in the world.
  void add(double time, double x, double y, double yaw);
  void clear() { poses_.clear(); }
  Speed speed() const;  ///< 0 until there is enough to tell

 private:
  struct Pose {
    double time, x, y, yaw;
  };
  std::deque<Pose> poses_;
};

}  // namespace gaitd::cli::teleop
