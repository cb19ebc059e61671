// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "gaitd/sim/terrain.h"

namespace gaitd::sim {
namespace {

constexpr double kRidge =
    0.005;  // m, by which a ridge stands out from the middle of its neighbours

constexpr double kFarAway = 1e5;  // m: of a robot whose simulation diverges

}  // namespace

HeightField::HeightField(std::shared_ptr<const terrain::HeightMap> map, double friction)
    : map_(std::move(map)), friction_(friction) {
  const terrain::Grid& grid = map_->grid();
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      ridges_.push_back(is_ridge(i, j));
      if (map_->known(i, j)) highest_ = std::max(highest_, map_->height(i, j));
    }
  }
}

// Along x or along y; a cell beside which nothing is known is none.
bool HeightField::is_ridge(int i, int j) const {
  const terrain::Grid& grid = map_->grid();
  const auto stands_out = [&](int di, int dj) {
    if (!grid.contains(i - di, j - dj) || !grid.contains(i + di, j + dj)) return false;
    const double middle = 0.5 * (map_->height(i - di, j - dj) + map_->height(i + di, j + dj));
    return map_->height(i, j) > middle + kRidge;
  };
  return stands_out(1, 0) || stands_out(0, 1);
}

HeightField::Depth HeightField::depth(const Eigen::Vector3d& p_W) const {
  const auto surface = map_->surface(p_W.head<2>());
  if (!surface) return {0.0, Eigen::Vector3d::UnitZ()};
  const double depth = (surface->height - p_W.z()) * surface->normal.z();
  return {std::min(depth, kDeepest), surface->normal};
}

void HeightField::find_ridges(const Eigen::Vector3d& center, double radius,
                              std::vector<Ridge>* near) const {
  near->clear();
  const terrain::Grid& grid = map_->grid();
  if (!(center.norm() < kFarAway)) return;
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(radius);
  const Eigen::Vector2i first =
      grid.cell(center.head<2>() - reach).cwiseMax(Eigen::Vector2i::Zero());
  const Eigen::Vector2i last = grid.cell(center.head<2>() + reach)
                                   .cwiseMin(Eigen::Vector2i(grid.columns - 1, grid.rows - 1));
  for (int j = first.y(); j <= last.y(); ++j) {
    for (int i = first.x(); i <= last.x(); ++i) {
      const int cell = j * grid.columns + i;
      if (!ridges_[static_cast<size_t>(cell)]) continue;
      const Eigen::Vector2d p = grid.centre(i, j);
      const double z = map_->height(i, j);
      if (std::abs(z - center.z()) < radius) near->push_back({{p.x(), p.y(), z}, cell});
    }
  }
}

}  // namespace gaitd::sim
