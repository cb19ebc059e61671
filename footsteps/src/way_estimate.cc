// SPDX-License-Identifier: Apache-2.0
#include "way_estimate.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "window.h"

namespace gaitd::footsteps {
namespace {

constexpr double kCoarseCell = 0.11;   // pelvis heights
constexpr double kAround = 0.2;        // pelvis heights, within which level ground is level
constexpr double kLevelSpread = 0.02;  // m
constexpr double kBeside = 0.6;        // pelvis heights
// Of the cost of level ground, where the legs do not pass, and where the arms do not: a map may be
// wrong by a cell, the robot may stand there already, and a stride may pass a narrow place.
constexpr double kBlocked = 60.0;
constexpr double kNarrow = 20.0;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

// m, from a cell to the highest or lowest of those beside it, of what is known.
double WayEstimate::drop(const std::vector<double>& ground, int i, int j) const {
  double most = 0.0;
  for (const auto& [u, v] : {std::pair{i - 1, j}, {i + 1, j}, {i, j - 1}, {i, j + 1}}) {
    const double other = grid_.contains(u, v) ? ground[index(u, v)] : kInfinity;
    const double apart = std::abs(other - ground[index(i, j)]);
    if (std::isfinite(apart)) most = std::max(most, apart);
  }
  return most;
}

WayEstimate::WayEstimate(const StepMaker& steps, double level, double uneven, WayMemory* memory)
    : level_(level), uneven_(uneven) {
  const terrain::Grid& fine = steps.footholds().map().grid();
  const int ratio =
      std::max(1, static_cast<int>(std::lround(kCoarseCell * steps.unit() / fine.resolution)));
  grid_.resolution = ratio * fine.resolution;
  grid_.origin = grid_.resolution * (fine.origin / grid_.resolution).array().floor().matrix();
  const Eigen::Vector2i last = grid_.cell(fine.centre(fine.columns - 1, fine.rows - 1));
  grid_.columns = last.x() + 1;
  grid_.rows = last.y() + 1;
  std::vector<Way> ways = ways_on_map(steps);
  if (memory != nullptr) recall(steps.unit(), memory, &ways);
  weights_.reserve(ways.size());
  for (const Way way : ways) weights_.push_back(weight(way));
}

double WayEstimate::weight(Way way) const {
  switch (way) {
    case Way::kLevel:
      return level_;
    case Way::kNarrow:
      return kNarrow * level_;
    case Way::kBlocked:
      return kBlocked * level_;
    default:
      return uneven_;
  }
}

std::vector<Way> WayEstimate::ways_on_map(const StepMaker& steps) const {
  const Footholds& footholds = steps.footholds();
  const terrain::HeightMap& map = footholds.map();
  const terrain::Grid& fine = map.grid();
  const std::size_t count = index(0, grid_.rows);
  std::vector<double> low(count, kInfinity), high(count, -kInfinity);
  for (int j = 0; j < fine.rows; ++j) {
    for (int i = 0; i < fine.columns; ++i) {
      if (!map.known(i, j)) continue;
      const Eigen::Vector2i cell = grid_.cell(fine.centre(i, j));
      const std::size_t at = index(cell.x(), cell.y());
      low[at] = std::min(low[at], map.height(i, j));
      high[at] = std::max(high[at], map.height(i, j));
    }
  }
  const int around = static_cast<int>(std::ceil(kAround * steps.unit() / grid_.resolution));
  const std::vector<double> least = best_around(grid_, low, around, std::less<>());
  const std::vector<double> most = best_around(grid_, high, around, std::greater<>());
  // What the feet stand on: a gap that they step over is as high as its edges.
  const std::vector<double> ground =
      best_around(grid_, best_around(grid_, high, 1, std::greater<>()), 1, std::less<>());
  const int beside = static_cast<int>(std::ceil(kBeside * steps.unit() / grid_.resolution));
  const std::vector<double> lowest = best_around(grid_, low, beside, std::less<>());
  std::vector<Way> ways(count, Way::kUnknown);
  for (int j = 0; j < grid_.rows; ++j) {
    for (int i = 0; i < grid_.columns; ++i) {
      const std::size_t at = index(i, j);
      const bool known = std::isfinite(ground[at]);
      // Where nothing is known the ground is as low as what is known beside it: walls have a back.
      const double lower = known ? ground[at] : lowest[at];
      if (!std::isfinite(lower)) continue;
      const Eigen::Vector2d p = grid_.centre(i, j);
      if (!footholds.legs_fit(p, lower) || drop(ground, i, j) >= steps.highest_step()) {
        ways[at] = Way::kBlocked;
      } else if (!footholds.arms_fit(p, lower)) {
        ways[at] = Way::kNarrow;
      } else if (known) {
        ways[at] = most[at] - least[at] < kLevelSpread ? Way::kLevel : Way::kUneven;
      }
    }
  }
  return ways;
}

void WayEstimate::recall(double unit, WayMemory* memory, std::vector<Way>* ways) {
  const terrain::Grid on_map = grid_;
  const int beside = static_cast<int>(std::ceil(kBeside * unit / grid_.resolution));
  memory->move_to(on_map.centre(on_map.columns / 2, on_map.rows / 2), on_map.resolution);
  for (int j = 0; j < on_map.rows; ++j) {
    for (int i = 0; i < on_map.columns; ++i) {
      const Eigen::Vector2d p = on_map.centre(i, j);
      const Way way = (*ways)[index(i, j)];
      // What is in the way at the border of the map may have left it.
      const bool border = std::min({i, j, on_map.columns - 1 - i, on_map.rows - 1 - j}) < beside;
      if (way == Way::kUnknown || (border && way < memory->at(p))) continue;
      memory->remember(p, way);
    }
  }
  grid_ = memory->around(on_map);
  ways->clear();
  ways->reserve(index(0, grid_.rows));
  for (int j = 0; j < grid_.rows; ++j) {
    for (int i = 0; i < grid_.columns; ++i) ways->push_back(memory->at(grid_.centre(i, j)));
  }
}

double WayEstimate::arrival(int i, int j) const {
  const auto cost = [&](int u, int v) {
    return grid_.contains(u, v) ? costs_[index(u, v)] : kInfinity;
  };
  const double across = std::min(cost(i - 1, j), cost(i + 1, j));
  const double along = std::min(cost(i, j - 1), cost(i, j + 1));
  const double step = weights_[index(i, j)] * grid_.resolution;
  const double apart = std::abs(across - along);
  if (!(apart < step)) return std::min(across, along) + step;
  return 0.5 * (across + along + std::sqrt(2.0 * step * step - apart * apart));
}

void WayEstimate::lead_to(const Eigen::Vector2d& goal) {
  if (goal == goal_) return;
  goal_ = goal;
  costs_.assign(weights_.size(), kInfinity);
  using Front = std::pair<double, std::size_t>;
  std::priority_queue<Front, std::vector<Front>, std::greater<>> front;
  const auto reach = [&](int i, int j, double cost) {
    double& known = costs_[index(i, j)];
    if (!(cost < known)) return;
    known = cost;
    front.emplace(cost, index(i, j));
  };
  const Eigen::Vector2i at = grid_.cell(goal);
  const bool inside = grid_.contains(at.x(), at.y());
  // The cells around the goal, or from beside the map all of its border.
  for (int j = 0; j < grid_.rows; ++j) {
    for (int i = 0; i < grid_.columns; ++i) {
      const bool border = i == 0 || j == 0 || i == grid_.columns - 1 || j == grid_.rows - 1;
      const bool near = std::max(std::abs(i - at.x()), std::abs(j - at.y())) <= 1;
      if (inside ? near : border)
        reach(i, j, (inside ? level_ : uneven_) * (grid_.centre(i, j) - goal).norm());
    }
  }
  while (!front.empty()) {
    const auto [cost, cell] = front.top();
    front.pop();
    if (cost > costs_[cell]) continue;
    const int i = static_cast<int>(cell % static_cast<std::size_t>(grid_.columns));
    const int j = static_cast<int>(cell / static_cast<std::size_t>(grid_.columns));
    for (const auto& [u, v] : {std::pair{i - 1, j}, {i + 1, j}, {i, j - 1}, {i, j + 1}}) {
      if (grid_.contains(u, v)) reach(u, v, arrival(u, v));
    }
  }
}

double WayEstimate::from(const Eigen::Vector2d& p) const {
  const Eigen::Vector2d q = (p - grid_.origin) / grid_.resolution - Eigen::Vector2d::Constant(0.5);
  const Eigen::Vector2d last(grid_.columns - 1, grid_.rows - 1);
  const Eigen::Vector2d on = q.cwiseMax(0.0).cwiseMin(last);
  const int i = std::min(static_cast<int>(on.x()), std::max(grid_.columns - 2, 0));
  const int j = std::min(static_cast<int>(on.y()), std::max(grid_.rows - 2, 0));
  const int u = std::min(i + 1, grid_.columns - 1), v = std::min(j + 1, grid_.rows - 1);
  const double x = on.x() - i, y = on.y() - j;
  const double cost = (1.0 - y) * ((1.0 - x) * costs_[index(i, j)] + x * costs_[index(u, j)]) +
                      y * ((1.0 - x) * costs_[index(i, v)] + x * costs_[index(u, v)]);
  const double aside = (q - on).norm();
  return cost + uneven_ * aside * grid_.resolution;
}

}  // namespace gaitd::footsteps
