// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "gaitd/walking/polygon.h"

namespace gaitd::plugins {

// max over the polygon of direction . p (m); 0 for an empty one.
double support(const walking::ConvexPolygon& polygon, const Eigen::Vector2d& direction);

// Where the ICP may be at touchdown, from the foothold, so that steps can still catch it, however
// many it takes (the infinite-step capture region of Koolen et al., IJRR 2012, for steps that keep
// to one pace). With the CMP at r in the sole B for the growth E of a step's time and the next
// foothold at d in the reach D, the ICP is next
//   x' = r + E (x - r) - d,  which has to be in the set V' of the other foot:
//   V = (V' + D + (E - 1) B) / E
// Support functions add up, so that those of both feet, h and h', follow from two equations.
struct CaptureSet {
  static constexpr int kDirections = 16;

  // `reach`: footholds of the step that follows, from the foothold; `reach_after`: those of the
  // step after that, from the next; `sole` and `sole_after`: where the CMP may be. All in one
  // frame, m.
  CaptureSet(const walking::ConvexPolygon& reach, const walking::ConvexPolygon& sole,
             const walking::ConvexPolygon& reach_after, const walking::ConvexPolygon& sole_after,
             double growth);
  CaptureSet() { limit.fill(0.0); }

  static Eigen::Vector2d direction(int i);
  std::array<double, kDirections> limit;  // m: direction(i) . x <= limit[i]
};

}  // namespace gaitd::plugins
