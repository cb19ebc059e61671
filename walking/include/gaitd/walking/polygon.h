// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

namespace gaitd::walking {

// Convex polygon in the plane, at most kCapacity vertices, counter-clockwise, no heap.
// One vertex is a point, two are a segment, none is empty.
class ConvexPolygon {
 public:
  static constexpr int kCapacity = 40;

  int size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const Eigen::Vector2d& vertex(int i) const { return vertices_[i]; }

  void clear() { size_ = 0; }
  // Adds a point; make_hull() has to follow. Points past the capacity are ignored.
  void add(const Eigen::Vector2d& p) {
    if (size_ < kCapacity) vertices_[size_++] = p;
  }
  // Replaces the points by their convex hull (Andrew's monotone chain).
  void make_hull();

  // Signed distance of p to the border, positive inside (m). Empty: -infinity.
  double inside_distance(const Eigen::Vector2d& p) const;
  // Point of the polygon closest to p. p itself when the polygon is empty.
  Eigen::Vector2d closest_point(const Eigen::Vector2d& p) const;
  // The polygon with every edge moved inwards by `margin` (m), or, where that leaves nothing, by
  // nearly as much as leaves something: of a narrow sole its line.
  ConvexPolygon inset(double margin) const;
  // What of it is not beyond the line of all p with normal . p = offset (m); `normal` of length 1.
  ConvexPolygon cut(const Eigen::Vector2d& normal, double offset) const;
  // With at most `size` >= 3 vertices: those go first that take the least area with them.
  ConvexPolygon reduced(int size) const;
  double area() const;  // m^2
  // All places that the polygon covers on its way along `way` (m): its sum with a segment. Of a
  // polygon with at most kCapacity - 2 vertices.
  ConvexPolygon swept(const Eigen::Vector2d& way) const;
  // Moved by `way` (m).
  ConvexPolygon moved(const Eigen::Vector2d& way) const;
  // Mean of the vertices.
  Eigen::Vector2d centre() const;

 private:
  // Every edge moved inwards; empty when nothing is left.
  ConvexPolygon clipped(double margin) const;

  std::array<Eigen::Vector2d, kCapacity> vertices_;
  int size_ = 0;
};

}  // namespace gaitd::walking
