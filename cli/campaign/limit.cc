// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/limit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gaitd::cli {
namespace {

// The limit may lie beyond the levels by as much of their range.
constexpr double kBeyond = 0.25;
// Widths of the fall, from a single step to half of the range: logistic scale, evenly in its
// logarithm.
constexpr double kSteepest = 0.001, kFlattest = 0.45;
constexpr int kWidths = 12;
// Runs that fail far below the limit, and that succeed far above it.
constexpr double kLapses[] = {0.0, 0.02, 0.05};
constexpr double kLuck = 0.005;

}  // namespace

double LimitPosterior::quantile(double probability) const {
  const double width = (high_ - low_) / static_cast<double>(cells_.size());
  double below = 0.0;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (below + cells_[i] >= probability) {
      return low_ + width * (static_cast<double>(i) + (probability - below) / cells_[i]);
    }
    below += cells_[i];
  }
  return high_;
}

LimitModel::LimitModel(int levels, double rate)
    : levels_(levels),
      success_(static_cast<std::size_t>(levels)),
      limits_(std::max(160, 3 * levels)) {
  for (int level = 0; level < levels; ++level) {
    const double place = static_cast<double>(level) / (levels - 1);
    std::vector<double>& success = success_[static_cast<std::size_t>(level)];
    for (int i = 0; i < limits_; ++i) {
      const double limit = -kBeyond + (1.0 + 2.0 * kBeyond) * (i + 0.5) / limits_;
      for (int k = 0; k < kWidths; ++k) {
        const double width = kSteepest * std::pow(kFlattest / kSteepest, k / (kWidths - 1.0));
        for (const double lapse : kLapses) {
          // Where runs fail as often as that anyway there would be no limit.
          if (lapse >= 0.6 * (1.0 - rate)) continue;
          const double share = (rate - kLuck) / (1.0 - lapse - kLuck);
          const double z = (limit - place) / width + std::log(share / (1.0 - share));
          success.push_back(kLuck + (1.0 - lapse - kLuck) / (1.0 + std::exp(-z)));
        }
      }
    }
  }
}

LimitPosterior LimitModel::posterior(const std::vector<Trial>& trials) const {
  std::vector<double> grid(success_[0].size(), 1.0);
  for (const Trial& trial : trials) {
    const std::vector<double>& success = success_[static_cast<std::size_t>(trial.level)];
    for (std::size_t i = 0; i < grid.size(); ++i) {
      grid[i] *= trial.success ? success[i] : 1.0 - success[i];
    }
    const double sum = std::accumulate(grid.begin(), grid.end(), 0.0);
    for (double& probability : grid) probability /= sum;
  }
  const std::size_t each = grid.size() / static_cast<std::size_t>(limits_);
  std::vector<double> cells(static_cast<std::size_t>(limits_));
  for (std::size_t i = 0; i < grid.size(); ++i) cells[i / each] += grid[i];
  const double sum = std::accumulate(cells.begin(), cells.end(), 0.0);
  for (double& probability : cells) probability /= sum;
  return {std::move(cells), -kBeyond, 1.0 + kBeyond};
}

std::vector<int> LimitModel::next_levels(const LimitPosterior& posterior, int count) const {
  std::vector<int> levels;
  for (int i = 0; i < count; ++i) {
    const double place = std::clamp(posterior.quantile((i + 0.5) / count), 0.0, 1.0);
    levels.push_back(static_cast<int>(std::lround(place * (levels_ - 1))));
  }
  return levels;
}

}  // namespace gaitd::cli
