// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/outline.h"

#include <algorithm>
#include <cmath>

namespace gaitd::daemon {

void reduce_outline(std::size_t most, std::vector<double>* points) {
  most = std::max<std::size_t>(most, 3);
  while (points->size() / 2 > most) {
    const std::size_t count = points->size() / 2;
    const auto at = [&](std::size_t i) { return points->data() + 2 * (i % count); };
    std::size_t least = 0;
    double least_area = INFINITY;
    for (std::size_t i = 0; i < count; ++i) {
      const double* a = at(i + count - 1);
      const double* b = at(i);
      const double* c = at(i + 1);
      const double area = std::abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
      if (area >= least_area) continue;
      least = i;
      least_area = area;
    }
    const auto begin = points->begin() + static_cast<std::ptrdiff_t>(2 * least);
    points->erase(begin, begin + 2);
  }
}

}  // namespace gaitd::daemon
