// SPDX-License-Identifier: Apache-2.0
// Convex parts of a set of cells.
#ifndef GAITD_TERRAIN_CONVEX_PARTS_H_
#define GAITD_TERRAIN_CONVEX_PARTS_H_

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace gaitd::terrain {

using Cells = std::vector<Eigen::Vector2i>;
using CellPolygon = std::vector<Eigen::Vector2d>;  // in cells, counter-clockwise

// Polygons of at most `most_points` corners through cells of `cells`, in none of which there is a
// cell for which `belongs` is false. Parts of fewer than `least` cells are left out.
std::vector<CellPolygon> convex_parts(const Cells& cells, int least, int most_points,
                                      const std::function<bool(int i, int j)>& belongs);

}  // namespace gaitd::terrain

#endif  // GAITD_TERRAIN_CONVEX_PARTS_H_
