// SPDX-License-Identifier: Apache-2.0
// Filters over the cells of a grid.
#ifndef GAITD_FOOTSTEPS_WINDOW_H_
#define GAITD_FOOTSTEPS_WINDOW_H_

#include <algorithm>
#include <cstddef>
#include <vector>

#include "gaitd/terrain/height_map.h"

namespace gaitd::footsteps {

// By cell, the best of `values` (by cell, rows one after the other) within `around` cells in both
// directions: the highest with std::greater, the lowest with std::less.
template <class T, class Better>
std::vector<T> best_around(const terrain::Grid& grid, const std::vector<T>& values, int around,
                           Better better) {
  const auto pass = [&](const std::vector<T>& from, int count, std::ptrdiff_t stride,
                        auto&& place) {
    std::vector<T> to = from;
    for (int j = 0; j < grid.rows; ++j) {
      for (int i = 0; i < grid.columns; ++i) {
        const auto here = static_cast<std::ptrdiff_t>(j) * grid.columns + i;
        const int at = place(i, j);
        T best = from[static_cast<std::size_t>(here)];
        for (int k = std::max(0, at - around); k <= std::min(count - 1, at + around); ++k) {
          best = std::min(best, from[static_cast<std::size_t>(here + (k - at) * stride)], better);
        }
        to[static_cast<std::size_t>(here)] = best;
      }
    }
    return to;
  };
  const std::vector<T> rows = pass(values, grid.columns, 1, [](int i, int) { return i; });
  return pass(rows, grid.rows, grid.columns, [](int, int j) { return j; });
}

}  // namespace gaitd::footsteps

#endif  // GAITD_FOOTSTEPS_WINDOW_H_
