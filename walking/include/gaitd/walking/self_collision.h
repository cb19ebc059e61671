// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/dynamics/kinematics.h"

namespace gaitd::walking {

// Nearest points of two segments a0-a1 and b0-b1.
struct NearestPoints {
  Eigen::Vector3d on_a, on_b;
};
NearestPoints nearest_points(const Eigen::Vector3d& a0, const Eigen::Vector3d& a1,
                             const Eigen::Vector3d& b0, const Eigen::Vector3d& b1);

// Keeps the capsules of the arms off those of the rest of the body and of the other arm. Legs among
// themselves are the business of the steps. Capsules that are at each other in the nominal posture,
// as an upper arm and the chest it hangs on, are left alone.
class SelfCollision {
 public:
  explicit SelfCollision(const GaitdModel& model);

  // Writes the separations of the pairs that are near into `out`; where there are too many, those
  // that need most.
  void update(const dynamics::Kinematics& kinematics, GaitdObjectives& out);
  double margin() const { return margin_; }  // m, that is kept between capsules
  // m, of the two that are nearest, as of the last update(); negative: they overlap. Infinite if
  // there is nothing that could touch.
  double clearance() const { return clearance_; }

 private:
  struct Pair {
    int first, second;  // capsules
  };

  const GaitdModel model_;
  const double height_;  // m, of the CoM in the nominal posture: the robot's size
  const double pace_;    // 1/s, sqrt(g / h)
  const double margin_;
  std::vector<Pair> pairs_;
  double clearance_ = std::numeric_limits<double>::infinity();
};

}  // namespace gaitd::walking
