// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/foothold_check.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/polygon.h"

namespace gaitd::walking {
namespace {

// Past the edge of the sole (m): rounding, and outlines of another model of it.
constexpr double kTolerance = 0.005;
// A corner that bends inwards by less is straight (m^2).
constexpr double kStraight = 1e-9;
// Of the width of the sole, half of it but for rounding: what is left has to hold the margins and
// errors of the CoP.
constexpr double kLeastShare = 0.499;

Eigen::Vector2d corner(const GaitdFootstep& step, int i) {
  const double(&p)[2] = step.contact_polygon[i % step.polygon_count];
  return {p[0], p[1]};
}

// Twice the area of the triangle, positive when it is counter-clockwise.
double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d ab = b - a, bc = c - b;
  return ab.x() * bc.y() - ab.y() * bc.x();
}

ConvexPolygon sole_of(const GaitdFoot& foot) {
  ConvexPolygon sole;
  for (int i = 0; i < foot.point_count; ++i) sole.add({foot.points[i][0], foot.points[i][1]});
  sole.make_hull();
  return sole;
}

// m, the least distance of two parallel lines around it.
double width(const ConvexPolygon& polygon) {
  double least = INFINITY;
  for (int i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon.vertex(i);
    const Eigen::Vector2d along = (polygon.vertex((i + 1) % polygon.size()) - a).normalized();
    double across = 0.0;
    for (int k = 0; k < polygon.size(); ++k) {
      const Eigen::Vector2d d = polygon.vertex(k) - a;
      across = std::max(across, along.x() * d.y() - along.y() * d.x());
    }
    least = std::min(least, across);
  }
  return polygon.size() < 3 ? 0.0 : least;
}

}  // namespace

Refusal check_contact_polygon(const GaitdModel& model, const GaitdFootstep& step, int number) {
  const int count = step.polygon_count;
  if (count == 0) return {};
  const char* side = side_name(step.side);
  if (count < 3 || count > GAITD_MAX_FOOT_POINTS) {
    return refuse(
        "footstep %d (%s): contact_polygon of %d points, 3 to %d expected, or none for "
        "the whole sole",
        number, side, count, GAITD_MAX_FOOT_POINTS);
  }
  const ConvexPolygon sole = sole_of(model.feet[step.side]);
  ConvexPolygon polygon;
  double area = 0.0, angle = 0.0;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d p = corner(step, i);
    const double inside = sole.inside_distance(p);
    if (!p.allFinite() || inside < -kTolerance) {
      return refuse(
          "footstep %d (%s): point %d of contact_polygon, [%.3f, %.3f] m, is %.3f m "
          "beside the sole, at most %.3f expected; leave out what the foot has not",
          number, side, i, p.x(), p.y(), -inside, kTolerance);
    }
    const Eigen::Vector2d next = corner(step, i + 1), after = corner(step, i + 2);
    if (turn(p, next, after) < -kStraight) {
      return refuse(
          "footstep %d (%s): contact_polygon bends inwards at point %d, or goes "
          "clockwise; a convex outline, counter-clockwise from above, expected",
          number, side, (i + 1) % count);
    }
    const Eigen::Vector2d in = next - p, out = after - next;
    area += 0.5 * (p.x() * next.y() - p.y() * next.x());
    angle += std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out));
    polygon.add(p);
  }
  if (area > 0.0 && angle > 3.0 * M_PI) {
    return refuse(
        "footstep %d (%s): contact_polygon goes round more than once; a convex outline "
        "expected",
        number, side);
  }
  polygon.make_hull();
  const double least = kLeastShare * width(sole);
  if (const double wide = width(polygon); !(wide >= least)) {
    return refuse(
        "footstep %d (%s): contact_polygon is %.3f m wide, at least %.3f expected, "
        "half of the sole; find a foothold that carries more of it",
        number, side, wide, least);
  }
  return {};
}

}  // namespace gaitd::walking
