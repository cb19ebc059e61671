// SPDX-License-Identifier: Apache-2.0
#include "daemon/verdict/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace gaitd::daemon {

namespace {

double percentile99(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  const std::size_t rank = (sorted.size() * 99 + 99) / 100 - 1;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(rank),
                   sorted.end());
  return sorted[rank];
}

}  // namespace

double compute_statistic(Statistic statistic, std::span<const double> values) {
  const bool unusable = values.empty() || std::any_of(values.begin(), values.end(),
                                                      [](double v) { return std::isnan(v); });
  if (unusable) return std::numeric_limits<double>::quiet_NaN();
  const auto count = static_cast<double>(values.size());
  double sum = 0.0;
  double squares = 0.0;
  for (const double value : values) {
    sum += value;
    squares += value * value;
  }
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  switch (statistic) {
    case Statistic::kRms:
      return std::sqrt(squares / count);
    case Statistic::kMean:
      return sum / count;
    case Statistic::kMin:
      return *low;
    case Statistic::kMax:
      return *high;
    case Statistic::kP99:
      return percentile99(values);
    case Statistic::kRange:
      return *high - *low;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace gaitd::daemon
