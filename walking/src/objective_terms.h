// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>

#include "gaitd/abi/types.h"
#include "gaitd/sdk/views.h"

// What the files that build objectives share.
namespace gaitd::walking {

inline constexpr std::uint32_t kAngularRows = 0b000111;
inline constexpr std::uint32_t kLinearRows = 0b111000;
inline constexpr std::uint32_t kAllRows = 0b111111;

inline double damping(double stiffness, double ratio) { return 2.0 * ratio * std::sqrt(stiffness); }

inline Eigen::Vector3d rotation_error(const Eigen::Quaterniond& goal,
                                      const Eigen::Quaterniond& now) {
  return sdk::log_so3(goal * now.conjugate());
}

}  // namespace gaitd::walking
