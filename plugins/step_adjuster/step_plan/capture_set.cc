// SPDX-License-Identifier: Apache-2.0
#include "capture_set.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gaitd::plugins {

double support(const walking::ConvexPolygon& polygon, const Eigen::Vector2d& direction) {
  if (polygon.empty()) return 0.0;
  double most = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < polygon.size(); ++i) {
    most = std::max(most, direction.dot(polygon.vertex(i)));
  }
  return most;
}

Eigen::Vector2d CaptureSet::direction(int i) {
  const double angle = 2.0 * M_PI * i / kDirections;
  return {std::cos(angle), std::sin(angle)};
}

CaptureSet::CaptureSet(const walking::ConvexPolygon& reach, const walking::ConvexPolygon& sole,
                       const walking::ConvexPolygon& reach_after,
                       const walking::ConvexPolygon& sole_after, double growth) {
  for (int i = 0; i < kDirections; ++i) {
    const Eigen::Vector2d n = direction(i);
    const double now = support(reach, n) + (growth - 1.0) * support(sole, n);
    const double after = support(reach_after, n) + (growth - 1.0) * support(sole_after, n);
    // growth h = h' + now,  growth h' = h + after
    limit[i] = (growth * now + after) / (growth * growth - 1.0);
  }
}

}  // namespace gaitd::plugins
