// SPDX-License-Identifier: Apache-2.0
#include "separation_rows.h"

#include <algorithm>

#include "gaitd/sdk/views.h"

namespace gaitd::plugins {

SeparationRows::SeparationRows(int velocity_size) {
  rows_.setZero(velocity_size, GAITD_MAX_SEPARATIONS);
  jacobian_.setZero(6, velocity_size);
}

void SeparationRows::begin(const dynamics::Dynamics& dynamics, const GaitdObjectives& objectives) {
  count_ = std::clamp<int>(objectives.separation_count, 0, GAITD_MAX_SEPARATIONS);
  added_.fill(false);
  for (int i = 0; i < count_; ++i) {
    const GaitdSeparation& s = objectives.separations[i];
    const Eigen::Vector3d normal = sdk::view(s.normal);
    rows_.col(i).setZero();
    targets_[i] = s.acceleration;
    weights_[i] = s.weight;
    for (int end = 0; end < 2; ++end) {
      const Eigen::Vector3d point = sdk::view(s.point[end]);
      const double sign = end == 0 ? 1.0 : -1.0;
      dynamics.frame_jacobian(s.body[end], point, jacobian_);
      rows_.col(i).noalias() += sign * jacobian_.bottomRows<3>().transpose() * normal;
      targets_[i] -=
          sign * normal.dot(dynamics.frame_bias_acceleration(s.body[end], point).tail<3>());
    }
  }
}

}  // namespace gaitd::plugins
