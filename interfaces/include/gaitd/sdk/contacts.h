// SPDX-License-Identifier: Apache-2.0
// The friction pyramid of a contact point.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "gaitd/abi/types.h"
#include "gaitd/sdk/views.h"

namespace gaitd::sdk {

inline constexpr int kFrictionEdges = 4;

// Unit, W: along the tangent of the contact, the other direction across, and against both.
inline Eigen::Vector3d friction_edge(const GaitdContactPoint& contact, int edge) {
  const Eigen::Vector3d normal = view(contact.normal);
  const Eigen::Vector3d tangent = view(contact.tangent);
  const Eigen::Vector3d side = normal.cross(tangent);
  const Eigen::Vector3d across = edge % 2 == 0 ? tangent : side;
  return (normal + (edge < 2 ? contact.friction : -contact.friction) * across).normalized();
}

}  // namespace gaitd::sdk
