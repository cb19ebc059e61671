// SPDX-License-Identifier: Apache-2.0
#include "cli/robot/sole_shape.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "daemon/config/outline.h"
#include "gaitd/dynamics/mesh_points.h"

namespace gaitd::porting {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::size_t kMostCorners = 7;  // with two hands, no more than a controller takes
constexpr int kRim = 64;                 // corners for the rim of a cylinder
constexpr double kStraight = 1e-4;   // m, by which a corner is beside the line of its neighbours
constexpr double kWritten = 1e-5;    // m, of what robot.yaml can say
constexpr double kThin = 0.002;      // m, what still counts as flat
constexpr double kThick = 0.010;     // m, for soles that are bent
constexpr double kLeastFlat = 0.35;  // of what the foot covers, seen from above
constexpr double kLeastArea = 4e-5;  // m^2
constexpr std::size_t kMostFaces = 100;
constexpr std::size_t kMostPoints = 4000000;  // of all shapes of a foot
constexpr double kMostTilt = 0.35;            // rad, of a sole against its neighbourhood

void add_shape(const Guess& guess, const dynamics::UrdfShape& shape, const Eigen::Isometry3d& X_BS,
               std::vector<ShapePoint>* points, Reasons* why) {
  const Vector3d half = 0.5 * shape.size;
  switch (shape.kind) {
    case dynamics::ShapeKind::kBox:
      for (int i = 0; i < 8; ++i) {
        const Vector3d sign((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
        // Each of the six faces once, at least.
        const Vector3d face = X_BS.linear() * (sign[i % 3] * Vector3d::Unit(i % 3));
        points->push_back({X_BS * half.cwiseProduct(sign), 0.0, face});
      }
      break;
    case dynamics::ShapeKind::kCylinder:
      for (int i = 0; i < 2 * kRim; ++i) {
        const double angle = 2.0 * M_PI * (i / 2) / kRim;
        const double end = i % 2 == 0 ? 1.0 : -1.0;
        points->push_back({X_BS * Vector3d(shape.size[0] * std::cos(angle),
                                           shape.size[0] * std::sin(angle), end * half[1]),
                           0.0, end * X_BS.linear().col(2)});
      }
      break;
    case dynamics::ShapeKind::kCapsule:
      for (const double end : {-1.0, 1.0}) {
        points->push_back({X_BS * Vector3d(0.0, 0.0, end * half[1]), shape.size[0]});
      }
      break;
    case dynamics::ShapeKind::kSphere:
      points->push_back({X_BS.translation(), shape.size[0]});
      break;
    case dynamics::ShapeKind::kMesh: {
      const auto file = dynamics::find_mesh(guess.urdf_file, shape.file);
      std::vector<Vector3d> corners;
      std::string error = "no such file";
      if (file.empty() || !dynamics::read_mesh_points(file, &corners, &error)) {
        why->push_back("Mesh " + shape.file + ": " + error + ".");
        break;
      }
      for (const Vector3d& corner : corners) {
        points->push_back({X_BS * corner.cwiseProduct(shape.size)});
      }
    }
  }
}

double depth(const ShapePoint& point, const Vector3d& down) {
  return point.p.dot(down) + point.radius;
}

// Points within `thickness` of the lowest.
std::vector<Vector3d> lowest(const std::vector<ShapePoint>& points, const Vector3d& down,
                             double thickness) {
  double bottom = -1e9;
  for (const ShapePoint& point : points) bottom = std::max(bottom, depth(point, down));
  std::vector<Vector3d> low;
  for (const ShapePoint& point : points) {
    if (depth(point, down) >= bottom - thickness) low.push_back(point.p + point.radius * down);
  }
  return low;
}

std::vector<Vector2d> hull_along(const std::vector<Vector3d>& points, const Vector3d& x,
                                 const Vector3d& y) {
  std::vector<Vector2d> flat;
  flat.reserve(points.size());
  for (const Vector3d& p : points) flat.emplace_back(p.dot(x), p.dot(y));
  return convex_hull(std::move(flat), 0.0);
}

double area_along(const std::vector<Vector3d>& points, const Vector3d& down) {
  const Vector3d x = down.unitOrthogonal();
  return polygon_area(hull_along(points, x, x.cross(down)));
}

// m, from the line of the two beside it.
double beside(const std::vector<Vector2d>& outline, std::size_t i) {
  const std::size_t n = outline.size();
  const Vector2d& before = outline[(i + n - 1) % n];
  const Vector2d way = outline[(i + 1) % n] - before;
  const Vector2d d = outline[i] - before;
  return std::abs(way.x() * d.y() - way.y() * d.x()) / std::max(way.norm(), 1e-9);
}

// Without the corners that meshes have along a straight edge.
void drop_straight(std::vector<Vector2d>* outline) {
  for (;;) {
    std::size_t least = 0;
    for (std::size_t i = 1; i < outline->size(); ++i) {
      if (beside(*outline, i) < beside(*outline, least)) least = i;
    }
    if (outline->size() <= 3 || beside(*outline, least) >= kStraight) return;
    outline->erase(outline->begin() + static_cast<std::ptrdiff_t>(least));
  }
}

// The normal of the plane through the lowest points, when they are nearly in one.
Vector3d fitted(const std::vector<ShapePoint>& points, Vector3d down) {
  for (int i = 0; i < 3; ++i) {
    const std::vector<Vector3d> low = lowest(points, down, kThin);
    if (low.size() < 3 || area_along(low, down) < kLeastArea) return down;
    Vector3d mean = Vector3d::Zero();
    for (const Vector3d& p : low) mean += p;
    mean /= static_cast<double>(low.size());
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Vector3d& p : low) spread += (p - mean) * (p - mean).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
    Vector3d normal = solver.eigenvectors().col(0);
    if (normal.dot(down) < 0) normal = -normal;
    if (normal.dot(down) < std::cos(kMostTilt)) return down;
    if (area_along(lowest(points, normal, kThin), normal) < area_along(low, down)) return down;
    down = normal;
  }
  return down;
}

}  // namespace

std::vector<ShapePoint> shape_points(const Guess& guess, int body, bool collisions, Reasons* why) {
  std::vector<ShapePoint> points;
  for (const bool collision : {true, false}) {
    if (collision && !collisions) continue;
    for (const dynamics::UrdfShape& shape : guess.outline.shapes) {
      const dynamics::UrdfLink* link = guess.urdf.find_link(shape.link);
      if (shape.collision != collision || link == nullptr || link->body != body) continue;
      const Eigen::Isometry3d X_BL = Eigen::Translation3d(link->p_BL) * link->R_BL;
      if (points.size() >= kMostPoints) {
        why->push_back("Only the first shapes were looked at: there are too many.");
        return points;
      }
      add_shape(guess, shape, X_BL * shape.X_LS, &points, why);
    }
    if (points.empty()) continue;
    why->push_back(collision ? "From the collision shapes."
                             : "From the visuals, as the collision shapes show no sole: check it.");
    break;
  }
  return points;
}

std::vector<Vector2d> convex_hull(std::vector<Vector2d> points, double least) {
  std::sort(points.begin(), points.end(), [](const Vector2d& a, const Vector2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  const auto turns_left = [least](const Vector2d& a, const Vector2d& b, const Vector2d& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x()) > least;
  };
  std::vector<Vector2d> hull;
  for (int way = 0; way < 2; ++way) {
    const std::size_t begin = hull.size();
    for (const Vector2d& point : points) {
      while (hull.size() >= begin + 2 && !turns_left(hull[hull.size() - 2], hull.back(), point)) {
        hull.pop_back();
      }
      hull.push_back(point);
    }
    if (!hull.empty()) hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

double polygon_area(const std::vector<Vector2d>& points) {
  double area = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector2d& a = points[i];
    const Vector2d& b = points[(i + 1) % points.size()];
    area += 0.5 * (a.x() * b.y() - b.x() * a.y());
  }
  return area;
}

void set_outline(std::vector<Vector2d> outline, SoleGuess* sole) {
  std::vector<double> flat;
  for (const Vector2d& p : outline) flat.insert(flat.end(), {p.x(), p.y()});
  daemon::reduce_outline(kMostCorners, &flat);
  outline.clear();
  for (std::size_t i = 0; i < flat.size(); i += 2) outline.emplace_back(flat[i], flat[i + 1]);
  Vector2d least = outline[0];
  Vector2d most = outline[0];
  for (const Vector2d& p : outline) {
    least = least.cwiseMin(p);
    most = most.cwiseMax(p);
  }
  const Vector2d middle = 0.5 * (least + most);
  const Eigen::Matrix3d& R = sole->frame.X_LF.linear();
  sole->frame.X_LF.translation() += R.col(0) * middle.x() + R.col(1) * middle.y();
  // Convex as it is written, too.
  for (Vector2d& p : outline) p = ((p - middle) / kWritten).array().round().matrix() * kWritten;
  sole->outline = convex_hull(std::move(outline));
}

bool find_sole(const std::vector<ShapePoint>& points, const Vector3d& down, const Vector3d& forward,
               SoleGuess* sole, std::string* error) {
  // As the foot hangs, as its link lies or as its shapes do: whichever shows the larger flat part.
  Vector3d best = down;
  double flat = area_along(lowest(points, down, kThin), down);
  const auto try_along = [&](const Vector3d& along) {
    if (along.dot(down) < 0.7) return;
    const double area = area_along(lowest(points, along, kThin), along);
    if (area <= 1.2 * flat) return;
    flat = area;
    best = along;
  };
  for (int axis = 0; axis < 6; ++axis) {
    try_along(Vector3d::Unit(axis / 2) * (axis % 2 == 0 ? 1.0 : -1.0));
  }
  std::vector<Vector3d> tried;  // a few hundred corners share a face
  for (const ShapePoint& point : points) {
    const bool again = std::any_of(tried.begin(), tried.end(),
                                   [&](const Vector3d& t) { return t.dot(point.face) > 0.99999; });
    if (point.face.isZero(0.0) || again || tried.size() >= kMostFaces) continue;
    tried.push_back(point.face);
    try_along(point.face);
  }
  best = fitted(points, best);
  const double covered = area_along(lowest(points, best, 1e9), best);
  double thickness = kThin;
  flat = area_along(lowest(points, best, thickness), best);
  if (flat < kLeastFlat * covered) {
    thickness = kThick;
    flat = area_along(lowest(points, best, thickness), best);
    sole->frame.why.push_back(
        format("Not flat: the lowest %.0f mm count as the sole.", 1e3 * thickness));
  }
  if (flat < kLeastArea) {
    *error = "no flat sole: the lowest part of the foot has no area";
    return false;
  }
  const std::vector<Vector3d> low = lowest(points, best, thickness);
  Eigen::Matrix3d R;
  R.col(2) = -best;
  R.col(0) = (forward - best * forward.dot(best)).normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  std::vector<Vector2d> hull = hull_along(low, R.col(0), R.col(1));
  drop_straight(&hull);
  const std::size_t corners = hull.size();
  double bottom = -1e9;
  for (const ShapePoint& point : points) bottom = std::max(bottom, depth(point, best));
  sole->frame.X_LF.linear() = R;
  sole->frame.X_LF.translation() = best * bottom;
  set_outline(std::move(hull), sole);
  Vector2d size = Vector2d::Zero();
  for (const Vector2d& p : sole->outline) size = size.cwiseMax(2.0 * p);
  sole->frame.why.push_back(format("The lowest corners, %.0f mm long and %.0f mm wide%s.",
                                   1e3 * size.x(), 1e3 * size.y(),
                                   corners > kMostCorners ? ", outline reduced to 7 points" : ""));
  return true;
}

}  // namespace gaitd::porting
