// SPDX-License-Identifier: Apache-2.0
#include "gaitd/terrain/height_map.h"

#include <algorithm>
#include <cmath>

namespace gaitd::terrain {
namespace {

// z of the highest point of `box` above (x, y), or NaN.
double top_of(const BoxShape& box, double x, double y) {
  // The vertical line in the frame of the box, and the part of it within each pair of faces.
  const Eigen::Vector3d p = box.R_WB.transpose() * (Eigen::Vector3d(x, y, 0.0) - box.center);
  const Eigen::Vector3d d = box.R_WB.row(2).transpose();
  double low = -INFINITY, high = INFINITY;
  clip_to_box(p, d, box.half, &low, &high);
  return low <= high ? high : HeightMap::kUnknown;
}

}  // namespace

HeightMap::HeightMap(const Grid& grid)
    : grid_(grid),
      heights_(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows),
               kUnknown),
      variances_(heights_.size(), 0.0) {}

int HeightMap::known_cells() const {
  return static_cast<int>(
      std::count_if(heights_.begin(), heights_.end(), [](double h) { return h == h; }));
}

std::optional<HeightMap::Surface> HeightMap::surface(const Eigen::Vector2d& p) const {
  const Eigen::Vector2d q = (p - grid_.origin) / grid_.resolution - Eigen::Vector2d::Constant(0.5);
  if (!(q.x() >= 0.0 && q.y() >= 0.0 && q.x() <= grid_.columns - 1 && q.y() <= grid_.rows - 1)) {
    return std::nullopt;
  }
  const int i = std::min(static_cast<int>(q.x()), grid_.columns - 2);
  const int j = std::min(static_cast<int>(q.y()), grid_.rows - 2);
  if (i < 0 || j < 0) return std::nullopt;
  const double a = height(i, j), b = height(i + 1, j);
  const double c = height(i, j + 1), d = height(i + 1, j + 1);
  const double u = q.x() - i, v = q.y() - j;
  const double h = (1 - v) * ((1 - u) * a + u * b) + v * ((1 - u) * c + u * d);
  if (!(h == h)) return std::nullopt;
  const double along_x = ((1 - v) * (b - a) + v * (d - c)) / grid_.resolution;
  const double along_y = ((1 - u) * (c - a) + u * (d - b)) / grid_.resolution;
  return Surface{h, Eigen::Vector3d(-along_x, -along_y, 1.0).normalized()};
}

void clip_to_box(const Eigen::Vector3d& p, const Eigen::Vector3d& d, const Eigen::Vector3d& half,
                 double* low, double* high) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(d[axis]) < 1e-12) {
      if (std::abs(p[axis]) > half[axis]) *high = -INFINITY;
      continue;
    }
    const double a = (-half[axis] - p[axis]) / d[axis];
    const double b = (half[axis] - p[axis]) / d[axis];
    *low = std::max(*low, std::min(a, b));
    *high = std::min(*high, std::max(a, b));
  }
}

void add_boxes(const std::vector<BoxShape>& boxes, HeightMap* map) {
  const Grid& grid = map->grid();
  for (const BoxShape& box : boxes) {
    const Eigen::Vector2d reach = (box.R_WB.cwiseAbs() * box.half).head<2>();
    const Eigen::Vector2i first =
        grid.cell(box.center.head<2>() - reach).cwiseMax(Eigen::Vector2i::Zero());
    const Eigen::Vector2i last = grid.cell(box.center.head<2>() + reach)
                                     .cwiseMin(Eigen::Vector2i(grid.columns - 1, grid.rows - 1));
    for (int j = first.y(); j <= last.y(); ++j) {
      for (int i = first.x(); i <= last.x(); ++i) {
        const Eigen::Vector2d p = grid.centre(i, j);
        const double top = top_of(box, p.x(), p.y());
        if (top == top && !(map->height(i, j) >= top)) map->set(i, j, top, map->variance(i, j));
      }
    }
  }
}

}  // namespace gaitd::terrain
