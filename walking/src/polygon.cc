// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/polygon.h"

#include <algorithm>
#include <limits>

namespace gaitd::walking {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

Eigen::Vector2d closest_on_segment(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                   const Eigen::Vector2d& p) {
  const Eigen::Vector2d d = b - a;
  const double l2 = d.squaredNorm();
  const double t = l2 > 0.0 ? std::clamp((p - a).dot(d) / l2, 0.0, 1.0) : 0.0;
  return a + t * d;
}

// Where the linear `height` is not negative (Sutherland and Hodgman).
template <class Height>
ConvexPolygon part_of(const ConvexPolygon& polygon, const Height& height) {
  ConvexPolygon part;
  for (int i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& p = polygon.vertex(i);
    const Eigen::Vector2d& q = polygon.vertex((i + 1) % polygon.size());
    const double hp = height(p);
    const double hq = height(q);
    if (hp >= 0.0) part.add(p);
    if ((hp > 0.0 && hq < 0.0) || (hp < 0.0 && hq > 0.0)) {
      part.add(p + (q - p) * (hp / (hp - hq)));
    }
  }
  return part;
}

}  // namespace

void ConvexPolygon::make_hull() {
  if (size_ < 2) return;
  auto less = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  };
  std::sort(vertices_.begin(), vertices_.begin() + size_, less);
  const auto last = std::unique(vertices_.begin(), vertices_.begin() + size_);
  const int n = static_cast<int>(last - vertices_.begin());
  if (n < 3) {
    size_ = n;
    return;
  }
  std::array<Eigen::Vector2d, 2 * kCapacity> hull;
  int k = 0;
  auto push = [&](const Eigen::Vector2d& p, int floor) {
    while (k >= floor + 2 && cross(hull[k - 1] - hull[k - 2], p - hull[k - 2]) <= 0.0) --k;
    hull[k++] = p;
  };
  for (int i = 0; i < n; ++i) push(vertices_[i], 0);
  const int upper = k - 1;
  for (int i = n - 2; i >= 0; --i) push(vertices_[i], upper);
  size_ = k - 1;
  std::copy(hull.begin(), hull.begin() + size_, vertices_.begin());
}

double ConvexPolygon::inside_distance(const Eigen::Vector2d& p) const {
  if (size_ == 0) return -std::numeric_limits<double>::infinity();
  if (size_ >= 3) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < size_; ++i) {
      const Eigen::Vector2d& a = vertices_[i];
      const Eigen::Vector2d d = (vertices_[(i + 1) % size_] - a).normalized();
      least = std::min(least, cross(d, p - a));
    }
    if (least >= 0.0) return least;
  }
  return -(closest_point(p) - p).norm();
}

Eigen::Vector2d ConvexPolygon::closest_point(const Eigen::Vector2d& p) const {
  if (size_ == 0) return p;
  if (size_ == 1) return vertices_[0];
  bool inside = size_ >= 3;
  Eigen::Vector2d best = vertices_[0];
  double best_distance = std::numeric_limits<double>::infinity();
  for (int i = 0; i < size_; ++i) {
    const Eigen::Vector2d& a = vertices_[i];
    const Eigen::Vector2d& b = vertices_[(i + 1) % size_];
    if (cross(b - a, p - a) < 0.0) inside = false;
    const Eigen::Vector2d c = closest_on_segment(a, b, p);
    const double distance = (c - p).squaredNorm();
    if (distance < best_distance) {
      best_distance = distance;
      best = c;
    }
  }
  return inside ? p : best;
}

ConvexPolygon ConvexPolygon::cut(const Eigen::Vector2d& normal, double offset) const {
  return part_of(*this, [&](const Eigen::Vector2d& p) { return offset - normal.dot(p); });
}

ConvexPolygon ConvexPolygon::reduced(int size) const {
  ConvexPolygon result = *this;
  while (result.size_ > size) {
    int least = 0;
    double smallest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < result.size_; ++i) {
      const Eigen::Vector2d& p = result.vertices_[i];
      const Eigen::Vector2d& before = result.vertices_[(i + result.size_ - 1) % result.size_];
      const Eigen::Vector2d& after = result.vertices_[(i + 1) % result.size_];
      const double lost = cross(p - before, after - before);
      if (lost >= smallest) continue;
      smallest = lost;
      least = i;
    }
    const auto at = result.vertices_.begin() + least;
    std::copy(at + 1, result.vertices_.begin() + result.size_, at);
    --result.size_;
  }
  return result;
}

double ConvexPolygon::area() const {
  double twice = 0.0;
  for (int i = 1; i + 1 < size_; ++i) {
    twice += cross(vertices_[i] - vertices_[0], vertices_[i + 1] - vertices_[0]);
  }
  return 0.5 * twice;
}

ConvexPolygon ConvexPolygon::clipped(double margin) const {
  ConvexPolygon result = *this;
  for (int i = 0; i < size_ && !result.empty(); ++i) {
    const Eigen::Vector2d& a = vertices_[i];
    const Eigen::Vector2d d = (vertices_[(i + 1) % size_] - a).normalized();
    result = part_of(result, [&](const Eigen::Vector2d& p) { return cross(d, p - a) - margin; });
  }
  return result;
}

ConvexPolygon ConvexPolygon::inset(double margin) const {
  if (size_ < 3) return *this;
  ConvexPolygon result = clipped(margin);
  if (!result.empty()) return result;
  // The widest margin that leaves something, to 1/64 of the one that does not.
  constexpr int kHalvings = 6;
  double inside = 0.0;
  double step = margin;
  for (int i = 0; i < kHalvings; ++i) {
    step *= 0.5;
    ConvexPolygon wider = clipped(inside + step);
    if (wider.empty()) continue;
    inside += step;
    result = wider;
  }
  if (result.empty()) result.add(centre());
  return result;
}

ConvexPolygon ConvexPolygon::moved(const Eigen::Vector2d& way) const {
  ConvexPolygon result = *this;
  for (int i = 0; i < size_; ++i) result.vertices_[i] += way;
  return result;
}

ConvexPolygon ConvexPolygon::swept(const Eigen::Vector2d& way) const {
  ConvexPolygon result;
  if (size_ < 3) {
    for (int i = 0; i < size_; ++i) {
      result.add(vertices_[i]);
      result.add(vertices_[i] + way);
    }
    result.make_hull();
    return result;
  }
  // An edge that looks along the way moves with it; a vertex between one that does and one that
  // does not is there twice.
  const auto moves = [&](int edge) {
    const Eigen::Vector2d& a = vertices_[edge];
    return cross(way, vertices_[(edge + 1) % size_] - a) > 0.0;
  };
  bool before = moves(size_ - 1);
  for (int i = 0; i < size_; ++i) {
    const bool after = moves(i);
    const Eigen::Vector2d& p = vertices_[i];
    result.add(before ? Eigen::Vector2d(p + way) : p);
    if (before != after) result.add(after ? Eigen::Vector2d(p + way) : p);
    before = after;
  }
  return result;
}

Eigen::Vector2d ConvexPolygon::centre() const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int i = 0; i < size_; ++i) sum += vertices_[i];
  return size_ > 0 ? Eigen::Vector2d(sum / size_) : sum;
}

}  // namespace gaitd::walking
