// SPDX-License-Identifier: Apache-2.0
#include "timing.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>

namespace gaitd::benchmarks {
namespace {

double now() {
  return std::chrono::duration<double, std::micro>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

// Cholesky factors of one 36 × 36 matrix, in plain loops: much like what a tick computes.
constexpr int kOrder = 36;
using Matrix = std::array<std::array<double, kOrder>, kOrder>;

double factor(const Matrix& h) {
  Matrix l = h;
  for (int j = 0; j < kOrder; ++j) {
    for (int i = j; i < kOrder; ++i) {
      double sum = l[i][j];
      for (int k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
      l[i][j] = i == j ? sum : sum / l[j][j];
    }
  }
  return l[kOrder - 1][kOrder - 1];
}

}  // namespace

Distribution distribution(std::vector<double> times) {
  if (times.empty()) return {};
  std::sort(times.begin(), times.end());
  const std::size_t last = times.size() - 1;
  return {times[last / 2], times[static_cast<std::size_t>(0.99 * static_cast<double>(last))],
          times[last]};
}

std::vector<double> least_of_five(int count, const std::function<void()>& begin,
                                  const std::function<void(int)>& step) {
  std::vector<double> least(count, std::numeric_limits<double>::infinity());
  for (int repeat = 0; repeat < 5; ++repeat) {
    begin();
    for (int k = 0; k < count; ++k) {
      const double start = now();
      step(k);
      least[k] = std::min(least[k], now() - start);
    }
  }
  return least;
}

double calibration() {
  Matrix h;
  for (int i = 0; i < kOrder; ++i) {
    for (int j = 0; j < kOrder; ++j) h[i][j] = i == j ? 2.0 * kOrder : 1.0 / (1 + i + j);
  }
  volatile double result = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (int repeat = 0; repeat < 300; ++repeat) {
    const double start = now();
    result = factor(h);
    least = std::min(least, now() - start);
  }
  (void)result;
  return least;
}

}  // namespace gaitd::benchmarks
