// SPDX-License-Identifier: Apache-2.0
#include "gaitd/terrain/planar_regions.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "convex_parts.h"

namespace gaitd::terrain {
namespace {

using Eigen::Vector2i;
using Eigen::Vector3d;

constexpr int kWindow = 2;  // cells, to either side of one whose normal is estimated

// z = height + slope . (cell - (i, j)), cells in units of the resolution.
struct Plane {
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  // per cell
  double height = 0.0;                              // m, at `at`
  Eigen::Vector2d at = Eigen::Vector2d::Zero();     // cells

  double z(int i, int j) const { return height + slope.dot(Eigen::Vector2d(i, j) - at); }
  Vector3d normal(double resolution) const {
    return Vector3d(-slope.x() / resolution, -slope.y() / resolution, 1.0).normalized();
  }
};

// Least squares over the cells that were added.
class PlaneFit {
 public:
  explicit PlaneFit(const Vector2i& first) : first_(first.cast<double>()) {}
  void add(int i, int j, double z) {
    const Vector3d row(i - first_.x(), j - first_.y(), 1.0);
    moments_ += row * row.transpose();
    right_ += z * row;
    ++count_;
  }
  int count() const { return count_; }
  Plane plane() const {
    const Vector3d x = moments_.ldlt().solve(right_);
    return {x.head<2>(), x.z(), first_};
  }

 private:
  Eigen::Vector2d first_;
  Eigen::Matrix3d moments_ = Eigen::Matrix3d::Zero();
  Vector3d right_ = Vector3d::Zero();
  int count_ = 0;
};

class Growing {
 public:
  Growing(const HeightMap& map, const RegionRules& rules)
      : map_(map), grid_(map.grid()), rules_(rules) {
    result_.labels.assign(std::size_t{1} * grid_.columns * grid_.rows, -1);
    smooth_.assign(result_.labels.size(), 0);
    normals_.assign(result_.labels.size(), Vector3d::UnitZ());
    for (int j = kWindow; j < grid_.rows - kWindow; ++j) {
      for (int i = kWindow; i < grid_.columns - kWindow; ++i) look_around(i, j);
    }
  }

  PlanarRegions run() {
    for (int j = 0; j < grid_.rows; ++j) {
      for (int i = 0; i < grid_.columns; ++i) {
        if (smooth_[index(i, j)] != 0 && label(i, j) < 0) grow({i, j});
      }
    }
    return std::move(result_);
  }

 private:
  std::size_t index(int i, int j) const { return std::size_t{1} * j * grid_.columns + i; }
  int& label(int i, int j) { return result_.labels[index(i, j)]; }

  void look_around(int i, int j) {
    // Least squares over a square, whose moments are known.
    constexpr int kSide = 2 * kWindow + 1;
    constexpr double kMoment = kSide * kWindow * (kWindow + 1) * kSide / 3.0;
    Plane plane;
    plane.at = Eigen::Vector2d(i, j);
    for (int v = -kWindow; v <= kWindow; ++v) {
      for (int u = -kWindow; u <= kWindow; ++u) {
        const double height = map_.height(i + u, j + v);
        plane.height += height / (kSide * kSide);
        plane.slope += height / kMoment * Eigen::Vector2d(u, v);
      }
    }
    if (!(plane.height == plane.height)) return;  // something is unknown
    for (int v = j - kWindow; v <= j + kWindow; ++v) {
      for (int u = i - kWindow; u <= i + kWindow; ++u) {
        if (std::abs(map_.height(u, v) - plane.z(u, v)) > rules_.roughness) return;
      }
    }
    normals_[index(i, j)] = plane.normal(grid_.resolution);
    smooth_[index(i, j)] = normals_[index(i, j)].z() > least_upright_ ? 1 : 0;
  }

  // Cells at the rims, where normals cannot be told, are taken by their distance alone.
  bool fits(const Vector2i& cell, const Plane& plane, const Vector3d& normal) const {
    const int i = cell.x(), j = cell.y();
    if (!map_.known(i, j)) return false;
    if (std::abs(map_.height(i, j) - plane.z(i, j)) * normal.z() > rules_.distance) return false;
    return smooth_[index(i, j)] == 0 || normals_[index(i, j)].dot(normal) > least_alike_;
  }

  void grow(const Vector2i& seed) {
    const int id = static_cast<int>(result_.regions.size());
    PlaneFit fit(seed);
    Plane plane;
    for (int v = -kWindow; v <= kWindow; ++v) {  // the window of a smooth cell is all known
      for (int u = -kWindow; u <= kWindow; ++u) {
        fit.add(seed.x() + u, seed.y() + v, map_.height(seed.x() + u, seed.y() + v));
      }
    }
    plane = fit.plane();
    Vector3d normal = plane.normal(grid_.resolution);
    fit = PlaneFit(seed);
    Cells cells = {seed};
    label(seed.x(), seed.y()) = id;
    int next_fit = 64;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const Vector2i cell = cells[k];
      fit.add(cell.x(), cell.y(), map_.height(cell.x(), cell.y()));
      if (fit.count() == next_fit) {
        plane = fit.plane();
        normal = plane.normal(grid_.resolution);
        next_fit *= 2;
      }
      for (const Vector2i& step :
           {Vector2i(1, 0), Vector2i(-1, 0), Vector2i(0, 1), Vector2i(0, -1)}) {
        const Vector2i next = cell + step;
        if (!grid_.contains(next.x(), next.y()) || label(next.x(), next.y()) >= 0) continue;
        if (!fits(next, plane, normal)) continue;
        label(next.x(), next.y()) = id;
        cells.push_back(next);
      }
    }
    const double cell_area = grid_.resolution * grid_.resolution;
    if (static_cast<double>(cells.size()) * cell_area < rules_.least_area) {
      // Nobody stands on so little; its cells may still belong to a neighbour.
      for (const Vector2i& cell : cells) {
        label(cell.x(), cell.y()) = -1;
        smooth_[index(cell.x(), cell.y())] = 0;
      }
      return;
    }
    add_region(id, cells, fit.plane());
  }

  void add_region(int id, const Cells& cells, const Plane& plane) {
    PlanarRegion region;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (const Vector2i& cell : cells) mean += cell.cast<double>();
    mean /= static_cast<double>(cells.size());
    const auto place = [&](const Eigen::Vector2d& cell) {
      const Eigen::Vector2d p =
          grid_.origin + grid_.resolution * (cell + Eigen::Vector2d::Constant(0.5));
      return Vector3d(p.x(), p.y(), plane.height + plane.slope.dot(cell - plane.at));
    };
    region.centre = place(mean);
    region.normal = plane.normal(grid_.resolution);
    const double cell_area = grid_.resolution * grid_.resolution;
    region.area = static_cast<double>(cells.size()) * cell_area;
    const auto belongs = [&](int i, int j) { return grid_.contains(i, j) && label(i, j) == id; };
    for (const CellPolygon& part :
         convex_parts(cells, static_cast<int>(rules_.least_area / cell_area),
                      GAITD_MAX_REGION_POINTS, belongs)) {
      region.parts.emplace_back();
      for (const Eigen::Vector2d& corner : part) region.parts.back().push_back(place(corner));
    }
    result_.regions.push_back(std::move(region));
  }

  const HeightMap& map_;
  const Grid grid_;
  const RegionRules rules_;
  const double least_upright_ = std::cos(rules_.max_slope);
  const double least_alike_ = std::cos(rules_.angle);
  PlanarRegions result_;
  std::vector<char> smooth_;
  std::vector<Vector3d> normals_;
};

}  // namespace

PlanarRegions find_planar_regions(const HeightMap& map, const RegionRules& rules) {
  return Growing(map, rules).run();
}

}  // namespace gaitd::terrain
