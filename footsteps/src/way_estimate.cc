// SPDX-License-Identifier: Apache-2.0
#include "way_estimate.h"

#include <algorithm>
#include <cmath>

namespace gaitd::footsteps {
namespace {

constexpr double kCell = 0.11;   // pelvis heights
constexpr double kAround = 0.2;  // pelvis heights, within which level ground is level
constexpr double kLevel = 0.02;  // m

}  // namespace

WayEstimate::WayEstimate(const terrain::HeightMap& map, double unit, double level, double uneven) {
  const terrain::Grid& fine = map.grid();
  const int ratio = std::max(1, static_cast<int>(std::lround(kCell * unit / fine.resolution)));
  grid_.resolution = ratio * fine.resolution;
  grid_.origin = fine.origin;
  grid_.columns = (fine.columns + ratio - 1) / ratio;
  grid_.rows = (fine.rows + ratio - 1) / ratio;
  std::vector<double> low(std::size_t{1} * grid_.columns * grid_.rows, INFINITY);
  std::vector<double> high(low.size(), -INFINITY);
  for (int j = 0; j < fine.rows; ++j) {
    for (int i = 0; i < fine.columns; ++i) {
      if (!map.known(i, j)) continue;
      const std::size_t at = std::size_t{1} * (j / ratio) * grid_.columns + i / ratio;
      low[at] = std::min(low[at], map.height(i, j));
      high[at] = std::max(high[at], map.height(i, j));
    }
  }
  const int around = static_cast<int>(std::ceil(kAround * unit / grid_.resolution));
  for (int j = 0; j < grid_.rows; ++j) {
    for (int i = 0; i < grid_.columns; ++i) {
      double least = INFINITY, most = -INFINITY;
      for (int v = std::max(0, j - around); v <= std::min(grid_.rows - 1, j + around); ++v) {
        for (int u = std::max(0, i - around); u <= std::min(grid_.columns - 1, i + around); ++u) {
          const std::size_t at = std::size_t{1} * v * grid_.columns + u;
          least = std::min(least, low[at]);
          most = std::max(most, high[at]);
        }
      }
      weights_.push_back(most - least < kLevel ? level : uneven);
    }
  }
}

double WayEstimate::between(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
  const double way = (b - a).norm();
  const int count = static_cast<int>(std::ceil(way / grid_.resolution)) + 1;
  double sum = 0.0;
  for (int k = 0; k < count; ++k) {
    const Eigen::Vector2i cell = grid_.cell(a + (b - a) * (k + 0.5) / count);
    const int i = std::clamp(cell.x(), 0, grid_.columns - 1);
    const int j = std::clamp(cell.y(), 0, grid_.rows - 1);
    sum += weights_[std::size_t{1} * j * grid_.columns + i];
  }
  return sum * way / count;
}

}  // namespace gaitd::footsteps
