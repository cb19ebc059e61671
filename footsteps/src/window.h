// SPDX-License-Identifier: Apache-2.0
// Filters over the cells of a grid.
#ifndef GAITD_FOOTSTEPS_WINDOW_H_
#define GAITD_FOOTSTEPS_WINDOW_H_

#include <algorithm>
#include <cstddef>
#include <vector>

#include "gaitd/terrain/height_map.h"

namespace gaitd::footsteps {

// Of `count` values, `stride` apart, each the best of those within `around` of it. `line` is for
// its own use, of at least `count`: the places ahead that may yet be the best, best first.
template <class T, class Better>
void best_along(const T* from, T* to, int count, std::ptrdiff_t stride, int around, Better better,
                std::vector<int>* line) {
  int* ahead = line->data();
  int first = 0, last = 0, next = 0;
  for (int at = 0; at < count; ++at) {
    for (; next < count && next <= at + around; ++next) {
      while (last > first && !better(from[ahead[last - 1] * stride], from[next * stride])) --last;
      ahead[last++] = next;
    }
    if (ahead[first] < at - around) ++first;
    to[at * stride] = from[ahead[first] * stride];
  }
}

// By cell, the best of `values` (by cell, rows one after the other) within `around` cells in both
// directions: the highest with std::greater, the lowest with std::less.
template <class T, class Better>
std::vector<T> best_around(const terrain::Grid& grid, const std::vector<T>& values, int around,
                           Better better) {
  std::vector<T> rows(values.size()), best(values.size());
  std::vector<int> line(static_cast<std::size_t>(std::max(grid.columns, grid.rows)));
  const auto columns = static_cast<std::ptrdiff_t>(grid.columns);
  for (int j = 0; j < grid.rows; ++j) {
    best_along(values.data() + j * columns, rows.data() + j * columns, grid.columns, 1, around,
               better, &line);
  }
  for (int i = 0; i < grid.columns; ++i) {
    best_along(rows.data() + i, best.data() + i, grid.rows, columns, around, better, &line);
  }
  return best;
}

}  // namespace gaitd::footsteps

#endif  // GAITD_FOOTSTEPS_WINDOW_H_
