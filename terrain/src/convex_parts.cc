// SPDX-License-Identifier: Apache-2.0
#include "convex_parts.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace gaitd::terrain {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

constexpr int kMostCuts = 64;     // of one set of cells
constexpr double kOnEdge = 1e-9;  // cells

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Andrew's monotone chain.
CellPolygon hull_of(const Cells& cells) {
  Cells sorted = cells;
  std::sort(sorted.begin(), sorted.end(), [](const Vector2i& a, const Vector2i& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  CellPolygon hull;
  const auto add = [&hull](const Vector2i& cell, std::size_t kept) {
    const Vector2d p = cell.cast<double>();
    while (hull.size() >= kept + 2 &&
           cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0.0) {
      hull.pop_back();
    }
    hull.push_back(p);
  };
  for (const Vector2i& cell : sorted) add(cell, 0);
  const std::size_t lower = hull.size() - 1;
  for (auto cell = sorted.rbegin() + 1; cell != sorted.rend(); ++cell) add(*cell, lower);
  hull.pop_back();
  return hull;
}

// Leaves out the corners that cost least area; what is left is inside.
void simplify(int most_points, CellPolygon* polygon) {
  CellPolygon& p = *polygon;
  while (p.size() > static_cast<std::size_t>(most_points)) {
    const std::size_t n = p.size();
    std::size_t least = 0;
    double area = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < n; ++i) {
      const double lost = cross(p[i] - p[(i + n - 1) % n], p[(i + 1) % n] - p[i]);
      if (lost < area) {
        area = lost;
        least = i;
      }
    }
    p.erase(p.begin() + static_cast<std::ptrdiff_t>(least));
  }
}

double area_of(const CellPolygon& p) {
  double twice = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) twice += cross(p[i], p[(i + 1) % p.size()]);
  return 0.5 * twice;
}

bool is_inside(const CellPolygon& p, const Vector2d& q) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (cross(p[(i + 1) % p.size()] - p[i], q - p[i]) < -kOnEdge) return false;
  }
  return true;
}

// Cells in the polygon that do not belong.
Cells strangers_in(const CellPolygon& polygon, const std::function<bool(int i, int j)>& belongs) {
  Vector2d low = polygon[0], high = polygon[0];
  for (const Vector2d& p : polygon) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  Cells strangers;
  for (int j = static_cast<int>(low.y()); j <= static_cast<int>(high.y()); ++j) {
    for (int i = static_cast<int>(low.x()); i <= static_cast<int>(high.x()); ++i) {
      if (!belongs(i, j) && is_inside(polygon, Vector2d(i, j))) strangers.emplace_back(i, j);
    }
  }
  return strangers;
}

struct Cut {
  Vector2d direction = Vector2d::UnitX();
  double place = 0.0;     // along it
  std::size_t clean = 0;  // cells on the side that has no stranger
};

// The straight cut that leaves most cells on a side without strangers.
Cut best_cut(const Cells& cells, const Cells& strangers) {
  Vector2d mean = Vector2d::Zero();
  for (const Vector2i& cell : cells) mean += cell.cast<double>();
  mean /= static_cast<double>(cells.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Vector2i& cell : cells) {
    const Vector2d d = cell.cast<double>() - mean;
    spread += d * d.transpose();
  }
  const Eigen::Matrix2d axes =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvectors();
  Cut best;
  for (const Vector2d& axis :
       {Vector2d(1, 0), Vector2d(0, 1), Vector2d(axes.col(0)), Vector2d(axes.col(1))}) {
    for (const double sign : {1.0, -1.0}) {
      const Vector2d direction = sign * axis;
      double first = std::numeric_limits<double>::infinity();
      for (const Vector2i& cell : strangers) {
        first = std::min(first, direction.dot(cell.cast<double>()));
      }
      const auto clean = static_cast<std::size_t>(
          std::count_if(cells.begin(), cells.end(), [&](const Vector2i& cell) {
            return direction.dot(cell.cast<double>()) < first - kOnEdge;
          }));
      if (clean > best.clean) best = {direction, first - kOnEdge, clean};
    }
  }
  if (best.clean == 0) return {axes.col(1), axes.col(1).dot(mean), 0};
  return best;
}

}  // namespace

std::vector<CellPolygon> convex_parts(const Cells& cells, int least, int most_points,
                                      const std::function<bool(int i, int j)>& belongs) {
  std::vector<CellPolygon> parts;
  std::vector<Cells> open = {cells};
  for (int cuts = 0; !open.empty() && cuts <= kMostCuts;) {
    const Cells set = std::move(open.back());
    open.pop_back();
    if (set.size() < static_cast<std::size_t>(std::max(least, 3))) continue;
    CellPolygon hull = hull_of(set);
    if (hull.size() < 3) continue;
    const Cells strangers = strangers_in(hull, belongs);
    if (strangers.empty()) {
      simplify(most_points, &hull);
      if (area_of(hull) > 0.5) parts.push_back(std::move(hull));
      continue;
    }
    const Cut cut = best_cut(set, strangers);
    Cells sides[2];
    for (const Vector2i& cell : set) {
      sides[cut.direction.dot(cell.cast<double>()) < cut.place ? 1 : 0].push_back(cell);
    }
    ++cuts;
    for (Cells& side : sides) open.push_back(std::move(side));
  }
  return parts;
}

}  // namespace gaitd::terrain
