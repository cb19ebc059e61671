// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>

#include "gaitd/abi/control.h"
#include "gaitd/abi/types.h"
#include "gaitd/sdk/views.h"

// What the files that build objectives share.
namespace gaitd::walking {

inline constexpr std::uint32_t kAngularRows = 0b000111;
inline constexpr std::uint32_t kRollRow = 0b000001;
inline constexpr std::uint32_t kLinearRows = 0b111000;
inline constexpr std::uint32_t kAllRows = 0b111111;

inline double damping(double stiffness, double ratio) { return 2.0 * ratio * std::sqrt(stiffness); }

// A task of a foot along the axes of its sole, and without the row of its roll: the leg cannot roll
// it by itself.
inline void leave_roll_free(const Eigen::Quaterniond& sole, GaitdTask& task) {
  sdk::store(sole, task.axes);
  auto angular = sdk::view(task.acceleration).head<3>();
  auto linear = sdk::view(task.acceleration).tail<3>();
  angular = (sole.conjugate() * Eigen::Vector3d(angular)).eval();
  linear = (sole.conjugate() * Eigen::Vector3d(linear)).eval();
  task.row_mask &= ~kRollRow;
}

inline double heading(const GaitdPose& pose) {
  return sdk::yaw_of(sdk::quaternion(pose.orientation));
}

inline double mean_heading(double a, double b) {
  return a + 0.5 * std::remainder(b - a, 2.0 * M_PI);
}

inline Eigen::Vector3d rotation_error(const Eigen::Quaterniond& goal,
                                      const Eigen::Quaterniond& now) {
  return sdk::log_so3(goal * now.conjugate());
}

}  // namespace gaitd::walking
