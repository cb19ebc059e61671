// SPDX-License-Identifier: Apache-2.0
#include "gaitd/footsteps/way_memory.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gaitd::footsteps {
namespace {

constexpr double kSize = 60.0;   // m, of the square
constexpr double kShift = 10.0;  // m, by which it moves at least

}  // namespace

void WayMemory::move_to(const Eigen::Vector2d& middle, double resolution) {
  if (resolution != grid_.resolution) clear();
  const int count = static_cast<int>(std::ceil(kSize / resolution));
  const Eigen::Vector2d before = grid_.origin + Eigen::Vector2d::Constant(0.5 * count * resolution);
  if (!cells_.empty() && (middle - before).lpNorm<Eigen::Infinity>() < kShift) return;
  terrain::Grid grid;
  grid.resolution = resolution;
  grid.columns = grid.rows = count;
  const Eigen::Vector2d corner = middle / resolution - Eigen::Vector2d::Constant(0.5 * count);
  grid.origin = resolution * corner.array().floor().matrix();
  WayMemory moved;
  moved.grid_ = grid;
  moved.cells_.assign(moved.index({0, count}), Way::kUnknown);
  for (int j = 0; !cells_.empty() && j < count; ++j) {
    for (int i = 0; i < count; ++i) {
      moved.cells_[moved.index({i, j})] = at(grid.centre(i, j));
    }
  }
  *this = std::move(moved);
}

Way WayMemory::at(const Eigen::Vector2d& p) const {
  if (cells_.empty()) return Way::kUnknown;
  const Eigen::Vector2i cell = grid_.cell(p);
  return grid_.contains(cell.x(), cell.y()) ? cells_[index(cell)] : Way::kUnknown;
}

void WayMemory::remember(const Eigen::Vector2d& p, Way way) {
  const Eigen::Vector2i cell = grid_.cell(p);
  if (!cells_.empty() && grid_.contains(cell.x(), cell.y())) cells_[index(cell)] = way;
}

void WayMemory::clear() { cells_.clear(); }

terrain::Grid WayMemory::around(const terrain::Grid& grid) const {
  if (cells_.empty()) return grid;
  Eigen::Vector2i low = grid_.cell(grid.centre(0, 0));
  Eigen::Vector2i high = grid_.cell(grid.centre(grid.columns - 1, grid.rows - 1));
  for (int j = 0; j < grid_.rows; ++j) {
    for (int i = 0; i < grid_.columns; ++i) {
      if (cells_[index({i, j})] == Way::kUnknown) continue;
      low = low.cwiseMin(Eigen::Vector2i(i, j));
      high = high.cwiseMax(Eigen::Vector2i(i, j));
    }
  }
  terrain::Grid all = grid;
  all.origin = grid_.origin + grid_.resolution * low.cast<double>();
  all.columns = high.x() - low.x() + 1;
  all.rows = high.y() - low.y() + 1;
  return all;
}

}  // namespace gaitd::footsteps
