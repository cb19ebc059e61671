// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <random>

#include "cli/random_draw.h"

namespace gaitd::cli {
namespace {

constexpr double kZ = 1.959964;       // 95 %, both sides
constexpr double kZPower = 0.841621;  // 80 %

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

SuccessInterval wilson_interval(int successes, int runs) {
  if (runs <= 0) return {};
  const double n = runs;
  const double share = successes / n;
  const double middle = share + kZ * kZ / (2.0 * n);
  const double half = kZ * std::sqrt(share * (1.0 - share) / n + kZ * kZ / (4.0 * n * n));
  const double scale = 1.0 + kZ * kZ / n;
  return {std::max(0.0, (middle - half) / scale), std::min(1.0, (middle + half) / scale)};
}

double mcnemar(std::int64_t only_first, std::int64_t only_second) {
  const std::int64_t n = only_first + only_second;
  double tail = 0.0;
  for (std::int64_t k = 0; k <= std::min(only_first, only_second); ++k) {
    const auto of = static_cast<double>(n), one = static_cast<double>(k);
    tail += std::exp(std::lgamma(of + 1.0) - std::lgamma(one + 1.0) - std::lgamma(of - one + 1.0) -
                     of * std::log(2.0));
  }
  return std::min(1.0, 2.0 * tail);
}

std::optional<double> pairs_for_shares(std::int64_t only_first, std::int64_t only_second,
                                       std::int64_t pairs) {
  if (only_first == only_second) return std::nullopt;
  const auto n = static_cast<double>(pairs);
  const double differ = static_cast<double>(only_first + only_second) / n;
  const double shift = static_cast<double>(only_first - only_second) / n;
  const double root =
      kZ * std::sqrt(differ) + kZPower * std::sqrt(std::max(0.0, differ - shift * shift));
  return std::ceil(root * root / (shift * shift));
}

namespace {

// Of Student's distribution, 97.5 %, by degrees of freedom from 1.
constexpr double kStudent[] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262};

}  // namespace

MeanInterval bootstrap_mean(const std::vector<double>& values, std::string_view name) {
  // Few values hardly resample to anything that was not seen: two alike would decide everything.
  if (values.size() >= 2 && values.size() - 2 < std::size(kStudent)) {
    const double mean = mean_of(values);
    double sum = 0.0;
    for (const double value : values) sum += (value - mean) * (value - mean);
    const auto n = static_cast<double>(values.size());
    const double half = kStudent[values.size() - 2] * std::sqrt(sum / (n - 1.0) / n);
    return {mean, mean - half, mean + half};
  }
  // Of a large sample a few resamples tell as much, and none takes longer than seconds.
  constexpr std::size_t kDraws = 20000000, kFewest = 200, kMost = 2000;
  const std::size_t n = values.size();
  const std::size_t resamples = std::clamp(kDraws / n, kFewest, kMost);
  std::mt19937_64 draws(static_cast<std::uint64_t>(uniform_draw(0, name, 0) * 0x1p53));
  std::vector<double> means(resamples);
  for (double& mean : means) {
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double place = static_cast<double>(draws() >> 11) * 0x1p-53 * static_cast<double>(n);
      sum += values[std::min(n - 1, static_cast<std::size_t>(place))];
    }
    mean = sum / static_cast<double>(n);
  }
  std::sort(means.begin(), means.end());
  const auto percentile = [&](double share) {
    return means[static_cast<std::size_t>(std::lround(share * static_cast<double>(resamples - 1)))];
  };
  return {mean_of(values), percentile(0.025), percentile(0.975)};
}

std::optional<double> values_for_mean(const std::vector<double>& values) {
  if (values.size() < 2) return std::nullopt;
  const double mean = mean_of(values);
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const double deviation = std::sqrt(squares / static_cast<double>(values.size() - 1));
  if (mean == 0.0 || deviation == 0.0) return std::nullopt;
  const double ratio = (kZ + kZPower) * deviation / mean;
  return std::ceil(ratio * ratio);
}

}  // namespace gaitd::cli
