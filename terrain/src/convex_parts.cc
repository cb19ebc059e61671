// SPDX-License-Identifier: Apache-2.0
#include "convex_parts.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
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

// The first and the last cell of every column, from left to right, upwards: no others are extreme
// in any direction.
Cells ends_of_columns(const Cells& cells) {
  int left = std::numeric_limits<int>::max(), right = std::numeric_limits<int>::min();
  for (const Vector2i& cell : cells) {
    left = std::min(left, cell.x());
    right = std::max(right, cell.x());
  }
  struct Ends {
    int low = std::numeric_limits<int>::max(), high = std::numeric_limits<int>::min();
  };
  std::vector<Ends> columns(cells.empty() ? 0 : static_cast<std::size_t>(right - left + 1));
  for (const Vector2i& cell : cells) {
    Ends& ends = columns[static_cast<std::size_t>(cell.x() - left)];
    ends.low = std::min(ends.low, cell.y());
    ends.high = std::max(ends.high, cell.y());
  }
  Cells result;
  int x = left;
  for (const Ends& ends : columns) {
    if (ends.low <= ends.high) result.emplace_back(x, ends.low);
    if (ends.low < ends.high) result.emplace_back(x, ends.high);
    ++x;
  }
  return result;
}

// Andrew's monotone chain.
CellPolygon hull_of(const Cells& cells) {
  const Cells sorted = ends_of_columns(cells);
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

// Cells in the polygon that do not belong.
Cells strangers_in(const CellPolygon& polygon, const std::function<bool(int i, int j)>& belongs) {
  Vector2d low = polygon[0], high = polygon[0];
  for (const Vector2d& p : polygon) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  struct Edge {
    Vector2d start, way;
  };
  std::vector<Edge> edges;
  edges.reserve(polygon.size());
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    edges.push_back({polygon[i], polygon[(i + 1) % polygon.size()] - polygon[i]});
  }
  const auto is_inside = [&edges](const Vector2d& q) {
    return std::all_of(edges.begin(), edges.end(), [&q](const Edge& edge) {
      return cross(edge.way, q - edge.start) >= -kOnEdge;
    });
  };
  Cells strangers;
  for (int j = static_cast<int>(low.y()); j <= static_cast<int>(high.y()); ++j) {
    for (int i = static_cast<int>(low.x()); i <= static_cast<int>(high.x()); ++i) {
      if (!belongs(i, j) && is_inside(Vector2d(i, j))) strangers.emplace_back(i, j);
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
  const Cells extreme = ends_of_columns(strangers);
  Cut best;
  for (const Vector2d& axis :
       {Vector2d(1, 0), Vector2d(0, 1), Vector2d(axes.col(0)), Vector2d(axes.col(1))}) {
    double first = std::numeric_limits<double>::infinity(), last = -first;
    for (const Vector2i& cell : extreme) {
      const double place = axis.dot(cell.cast<double>());
      first = std::min(first, place);
      last = std::max(last, place);
    }
    std::size_t before = 0, behind = 0;
    for (const Vector2i& cell : cells) {
      const double place = axis.dot(cell.cast<double>());
      before += place < first - kOnEdge ? 1 : 0;
      behind += place > last + kOnEdge ? 1 : 0;
    }
    if (before > best.clean) best = {axis, first - kOnEdge, before};
    if (behind > best.clean) best = {-axis, -last - kOnEdge, behind};
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
