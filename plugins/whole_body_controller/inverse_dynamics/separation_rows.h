// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "gaitd/abi/types.h"
#include "gaitd/dynamics/dynamics.h"

namespace gaitd::plugins {

// The separations of the objectives as rows of the accelerations: row vdot >= target. One that a
// solution falls short of becomes a cost of the next one; a bound could contradict what holds the
// robot up.
class SeparationRows {
 public:
  explicit SeparationRows(int velocity_size);

  // Of this tick; none is a cost yet.
  void begin(const dynamics::Dynamics& dynamics, const GaitdObjectives& objectives);
  // Calls `add(row, target, weight)` for each that `acceleration` falls short of and that is no
  // cost yet. Whether there was one.
  template <class Add>
  bool add_missed(const Eigen::VectorXd& acceleration, Add&& add) {
    constexpr double kMissed = 0.05;  // m/s^2
    bool found = false;
    for (int i = 0; i < count_; ++i) {
      if (added_[i] || rows_.col(i).dot(acceleration) > targets_[i] - kMissed) continue;
      added_[i] = found = true;
      add(rows_.col(i), targets_[i], weights_[i]);
    }
    return found;
  }

 private:
  int count_ = 0;
  Eigen::MatrixXd rows_;  // nv x count, a column each
  dynamics::Matrix6X jacobian_;
  std::array<double, GAITD_MAX_SEPARATIONS> targets_{}, weights_{};
  std::array<bool, GAITD_MAX_SEPARATIONS> added_{};
};

}  // namespace gaitd::plugins
