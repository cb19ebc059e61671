// SPDX-License-Identifier: Apache-2.0
#include "gaitd/terrain/ground_memory.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace gaitd::terrain {
namespace {

constexpr double kSlack = 0.1;   // of the square, by which the robot may be off its middle
constexpr double kLevel = 0.03;  // m, by which heights around a hole, or beside a cell, agree
constexpr int kNeighbours = 5;   // of eight, that have to be known around a hole
constexpr int kClosings = 2;     // cells, of half the width of a hole that is closed
constexpr float kNothing = -INFINITY;

// Seen from above; `outline` counter-clockwise.
bool contains(std::span<const Eigen::Vector3d> outline, const Eigen::Vector2d& p) {
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Eigen::Vector2d a = outline[k].head<2>();
    const Eigen::Vector2d d = outline[(k + 1) % outline.size()].head<2>() - a;
    if (d.x() * (p.y() - a.y()) - d.y() * (p.x() - a.x()) < 0.0) return false;
  }
  return true;
}

}  // namespace

GroundMemory::GroundMemory(const MemoryRules& rules) : rules_(rules) {
  const int cells = std::max(2, static_cast<int>(std::lround(rules.size / rules.resolution)));
  grid_ = Grid{cells, cells, rules.resolution, Eigen::Vector2d::Zero()};
}

void GroundMemory::prepare() {
  if (!cells_.empty()) return;
  const std::size_t count =
      static_cast<std::size_t>(grid_.columns) * static_cast<std::size_t>(grid_.rows);
  cells_.resize(count);
  highest_.assign(count, kNothing);
  sum_.assign(count, 0.0F);
  weight_.assign(count, 0.0F);
}

void GroundMemory::clear() {
  std::fill(cells_.begin(), cells_.end(), Cell{});
  ++revision_;
}

void GroundMemory::clear_found() {
  for (Cell& cell : cells_) {
    if (!cell.told) cell = {};
    cell.doubts = 0;
  }
  ++revision_;
}

void GroundMemory::move_to(const Eigen::Vector2d& middle) {
  const double half = 0.5 * grid_.resolution * grid_.columns;
  const Eigen::Vector2d wanted = middle - Eigen::Vector2d::Constant(half);
  // Whole cells of W: maps of the same resolution have the same cells.
  const Eigen::Vector2d origin =
      (wanted / grid_.resolution).array().round().matrix() * grid_.resolution;
  if (!placed_) {
    grid_.origin = origin;
    placed_ = true;
    return;
  }
  if ((origin - grid_.origin).cwiseAbs().maxCoeff() < kSlack * half) return;
  const Eigen::Vector2i by =
      ((origin - grid_.origin) / grid_.resolution).array().round().cast<int>();
  std::vector<Cell> before(cells_.size());
  before.swap(cells_);
  for (int j = 0; !cells_.empty() && j < grid_.rows; ++j) {
    for (int i = 0; i < grid_.columns; ++i) {
      if (!grid_.contains(i + by.x(), j + by.y())) continue;
      at(i, j) =
          before[static_cast<std::size_t>(j + by.y()) * static_cast<std::size_t>(grid_.columns) +
                 static_cast<std::size_t>(i + by.x())];
    }
  }
  grid_.origin = origin;
  if (!cells_.empty()) ++revision_;
}

double GroundMemory::variance_at(const Cell& cell, double time) const {
  if (cell.told || cell.doubts == kFelt) return static_cast<double>(cell.variance);
  const double age = std::max(0.0, time - static_cast<double>(cell.seen));
  return static_cast<double>(cell.variance) + rules_.drift * rules_.drift * age;
}

void GroundMemory::learn(Cell* cell, double height, double variance, double time) const {
  if (cell->doubts == kFelt) return;
  const bool known = cell->variance >= 0.0F;
  const double before = known ? variance_at(*cell, time) : 0.0;
  const double off = height - static_cast<double>(cell->height);
  const bool fits = known && std::abs(off) < rules_.contradiction +
                                                 rules_.believable * std::sqrt(before + variance);
  if (known && !fits && ++cell->doubts < rules_.repeated) return;
  cell->doubts = 0;
  cell->told = cell->told && fits;
  cell->seen = static_cast<float>(time);
  if (!fits) {
    cell->height = static_cast<float>(height);
    cell->variance = static_cast<float>(variance);
    return;
  }
  const double gain = before / (before + variance);
  cell->height += static_cast<float>(gain * off);
  cell->variance = static_cast<float>((1.0 - gain) * before);
}

void GroundMemory::see(std::span<const SeenPoint> points, double common, double time) {
  prepare();
  touched_.clear();
  const auto cell_of = [this](const SeenPoint& point) {
    const Eigen::Vector2i c = grid_.cell(point.p.head<2>());
    return grid_.contains(c.x(), c.y()) ? c.y() * grid_.columns + c.x() : -1;
  };
  for (const SeenPoint& point : points) {
    if (!point.p.allFinite() || !(point.variance > 0.0)) continue;
    const int cell = cell_of(point);
    if (cell < 0) continue;
    float& highest = highest_[static_cast<std::size_t>(cell)];
    if (highest == kNothing) touched_.push_back(cell);
    highest = std::max(highest, static_cast<float>(point.p.z()));
  }
  for (const SeenPoint& point : points) {
    if (!point.p.allFinite() || !(point.variance > 0.0)) continue;
    const int cell = cell_of(point);
    if (cell < 0) continue;
    const auto k = static_cast<std::size_t>(cell);
    const float below = highest_[k] - static_cast<float>(point.p.z());
    if (below > static_cast<float>(rules_.mixed)) continue;
    const auto weight = static_cast<float>(1.0 / point.variance);
    sum_[k] -= weight * below;
    weight_[k] += weight;
  }
  for (const int cell : touched_) {
    const auto k = static_cast<std::size_t>(cell);
    learn(&cells_[k], static_cast<double>(highest_[k] + sum_[k] / weight_[k]),
          common + 1.0 / static_cast<double>(weight_[k]), time);
    highest_[k] = kNothing;
    sum_[k] = weight_[k] = 0.0F;
  }
  if (!touched_.empty()) ++revision_;
}

template <class Visit>
void GroundMemory::visit(std::span<const Eigen::Vector3d> outline, const Visit& visit) {
  if (outline.size() < 3) return;
  prepare();
  Eigen::Vector2d low = outline[0].head<2>(), high = low;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < outline.size(); ++k) {
    low = low.cwiseMin(outline[k].head<2>());
    high = high.cwiseMax(outline[k].head<2>());
    middle += outline[k] / static_cast<double>(outline.size());
  }
  for (std::size_t k = 0; k < outline.size(); ++k) {
    normal += (outline[k] - middle).cross(outline[(k + 1) % outline.size()] - middle);
  }
  if (!(normal.z() > 0.0)) return;
  const Eigen::Vector2i first = grid_.cell(low).cwiseMax(Eigen::Vector2i::Zero());
  const Eigen::Vector2i last =
      grid_.cell(high).cwiseMin(Eigen::Vector2i(grid_.columns - 1, grid_.rows - 1));
  for (int j = first.y(); j <= last.y(); ++j) {
    for (int i = first.x(); i <= last.x(); ++i) {
      const Eigen::Vector2d p = grid_.centre(i, j);
      if (!contains(outline, p)) continue;
      visit(at(i, j), p, middle.z() - normal.head<2>().dot(p - middle.head<2>()) / normal.z());
    }
  }
}

void GroundMemory::stand_on(std::span<const Eigen::Vector3d> outline, double variance,
                            double time) {
  bool learned = false;
  visit(outline, [&](Cell& cell, const Eigen::Vector2d&, double height) {
    if (cell.variance >= 0.0F && variance_at(cell, time) < rules_.unknown * rules_.unknown) return;
    cell = Cell{};
    learn(&cell, height, variance, time);
    learned = true;
  });
  if (learned) ++revision_;
}

void GroundMemory::sink(std::span<const Eigen::Vector3d> outline,
                        std::span<const Eigen::Vector3d> bears, double time) {
  bool learned = false;
  visit(outline, [&](Cell& cell, const Eigen::Vector2d& p, double height) {
    if (cell.doubts == kFelt || contains(bears, p)) return;
    cell.height = static_cast<float>(height - rules_.hollow);
    cell.variance = 0.0F;
    cell.seen = static_cast<float>(time);
    cell.told = false;
    cell.doubts = kFelt;
    learned = true;
  });
  if (learned) ++revision_;
}

std::optional<GroundMemory::Cell> GroundMemory::told_by(const HeightMap& tile,
                                                        const Eigen::Vector2i& low,
                                                        const Eigen::Vector2i& high, bool forget,
                                                        double time) const {
  Cell unknown;
  unknown.told = true;
  Cell highest = unknown;
  highest.seen = static_cast<float>(time);
  for (int v = low.y(); v <= high.y(); ++v) {
    for (int u = low.x(); u <= high.x(); ++u) {
      if (!tile.known(u, v)) {
        if (forget) return unknown;
        continue;
      }
      if (!(tile.variance(u, v) < rules_.unknown * rules_.unknown)) return unknown;
      const auto height = static_cast<float>(tile.height(u, v));
      if (highest.variance >= 0.0F && height <= highest.height) continue;
      highest.height = height;
      highest.variance = static_cast<float>(tile.variance(u, v));
    }
  }
  return highest.variance >= 0.0F ? std::optional(highest) : std::nullopt;
}

GroundMemory::Taken GroundMemory::put(const HeightMap& tile, bool forget, double time) {
  prepare();
  const Grid& from = tile.grid();
  const Eigen::Vector2d size = from.resolution * Eigen::Vector2d(from.columns, from.rows);
  const Eigen::Vector2i first = grid_.cell(from.origin).cwiseMax(Eigen::Vector2i::Zero());
  const Eigen::Vector2i last =
      grid_.cell(from.origin + size).cwiseMin(Eigen::Vector2i(grid_.columns - 1, grid_.rows - 1));
  // From the middle of a cell to the furthest cells of the tile whose middles are in it; larger
  // ones have none in it, and count where they are.
  const Eigen::Vector2d reach =
      Eigen::Vector2d::Constant(std::max(0.0, 0.5 * (grid_.resolution - from.resolution)));
  // What a tile fills in part is left to the one that fills it.
  const auto fills = [&](const Eigen::Vector2i& cell) {
    const Eigen::Vector2d p = grid_.centre(cell.x(), cell.y());
    const Eigen::Vector2i low = from.cell(p - reach), high = from.cell(p + reach);
    return from.contains(low.x(), low.y()) && from.contains(high.x(), high.y());
  };
  for (int j = first.y(); j <= last.y(); ++j) {
    for (int i = first.x(); i <= last.x(); ++i) {
      if (!fills({i, j})) continue;
      const Eigen::Vector2d p = grid_.centre(i, j);
      const auto cell = told_by(tile, from.cell(p - reach), from.cell(p + reach), forget, time);
      if (cell) at(i, j) = *cell;
    }
  }
  Taken taken;
  for (int j = 0; j < from.rows; ++j) {
    for (int i = 0; i < from.columns; ++i) {
      if (!tile.known(i, j)) continue;
      const Eigen::Vector2i c = grid_.cell(from.centre(i, j));
      ++(!grid_.contains(c.x(), c.y())       ? taken.far
         : !fills(c)                         ? taken.partly
         : at(c.x(), c.y()).variance >= 0.0F ? taken.cells
                                             : taken.uncertain);
    }
  }
  ++revision_;
  return taken;
}

HeightMap GroundMemory::map(double time) const {
  Eigen::Vector2i first(grid_.columns, grid_.rows), last(-1, -1);
  const double worst = rules_.unknown * rules_.unknown;
  for (int j = 0; !cells_.empty() && j < grid_.rows; ++j) {
    for (int i = 0; i < grid_.columns; ++i) {
      if (at(i, j).variance < 0.0F && !at(i, j).told) continue;
      first = first.cwiseMin(Eigen::Vector2i(i, j));
      last = last.cwiseMax(Eigen::Vector2i(i, j));
    }
  }
  if (last.x() < first.x()) return HeightMap(Grid{2, 2, grid_.resolution, grid_.origin});
  Grid part = grid_;
  part.columns = std::max(2, last.x() - first.x() + 1);
  part.rows = std::max(2, last.y() - first.y() + 1);
  part.origin = grid_.origin + grid_.resolution * first.cast<double>();
  HeightMap raw(part);
  for (int j = 0; j < part.rows; ++j) {
    for (int i = 0; i < part.columns; ++i) {
      if (!grid_.contains(i + first.x(), j + first.y())) continue;
      const Cell& cell = at(i + first.x(), j + first.y());
      if (cell.variance < 0.0F) {
        if (cell.told) raw.set(i, j, HeightMap::kUnknown, INFINITY);
        continue;
      }
      const double variance = variance_at(cell, time);
      if (variance < worst) raw.set(i, j, static_cast<double>(cell.height), variance);
    }
  }
  struct Around {
    double sum = 0.0, weight = 0.0, low = INFINITY, high = -INFINITY, worst = 0.0;
    int known = 0;
  };
  // Of the cells beside (i, j), those whose height is within kLevel of `height` (NaN: all).
  const auto around = [&part](const HeightMap& map, int i, int j, double height) {
    Around a;
    for (int v = std::max(0, j - 1); v <= std::min(part.rows - 1, j + 1); ++v) {
      for (int u = std::max(0, i - 1); u <= std::min(part.columns - 1, i + 1); ++u) {
        if ((u == i && v == j) || !map.known(u, v)) continue;
        const double h = map.height(u, v);
        if (std::abs(h - height) > kLevel) continue;
        const double weight = 1.0 / std::max(1e-8, map.variance(u, v));
        a.sum += weight * h;
        a.weight += weight;
        a.low = std::min(a.low, h);
        a.high = std::max(a.high, h);
        a.worst = std::max(a.worst, map.variance(u, v));
        ++a.known;
      }
    }
    return a;
  };
  for (int closing = 0; closing < kClosings; ++closing) {
    HeightMap closed = raw;
    for (int j = 0; j < part.rows; ++j) {
      for (int i = 0; i < part.columns; ++i) {
        if (raw.known(i, j) || std::isinf(raw.variance(i, j))) continue;
        const Around a = around(raw, i, j, HeightMap::kUnknown);
        if (a.known >= kNeighbours && a.high - a.low < kLevel) {
          closed.set(i, j, a.sum / a.weight, a.worst);
        }
      }
    }
    raw = std::move(closed);
  }
  HeightMap smooth = raw;
  for (int j = 0; j < part.rows; ++j) {
    for (int i = 0; i < part.columns; ++i) {
      if (!raw.known(i, j)) continue;
      const double h = raw.height(i, j);
      const Around a = around(raw, i, j, h);
      const double weight = 1.0 / std::max(1e-8, raw.variance(i, j));
      smooth.set(i, j, (a.sum + weight * h) / (a.weight + weight), raw.variance(i, j));
    }
  }
  return smooth;
}

}  // namespace gaitd::terrain
