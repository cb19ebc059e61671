// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace gaitd::daemon {

// Takes corners out of a convex polygon (x, y, x, y, ... in m) until `most` are left, each time the
// one that costs the least area. What is left lies inside the polygon.
void reduce_outline(std::size_t most, std::vector<double>* points);

}  // namespace gaitd::daemon
