// SPDX-License-Identifier: Apache-2.0
// What a robot remembers of the ways beside its map, which ends some metres from it.
#ifndef GAITD_FOOTSTEPS_WAY_MEMORY_H_
#define GAITD_FOOTSTEPS_WAY_MEMORY_H_

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "gaitd/terrain/height_map.h"

namespace gaitd::footsteps {

// How the middle of the feet passes a place.
enum class Way : std::uint8_t {
  kUnknown,
  kLevel,
  kUneven,
  kNarrow,  // only the legs do
  kBlocked
};

// By coarse cells of a square that moves with the robot. A map of 2 cm cells is forgotten where the
// robot has left, and with it the wall that it has just walked along: from its end the way back
// would look shorter than the one around it.
class WayMemory {
 public:
  // Where the map of this moment is: `middle`, m, W. Cells of `resolution` (m) have corners at its
  // multiples; where it is another than before, all is forgotten.
  void move_to(const Eigen::Vector2d& middle, double resolution);

  Way at(const Eigen::Vector2d& p) const;  // m, W
  void remember(const Eigen::Vector2d& p, Way way);
  void clear();

  // The cells of which something is known, with `grid`, of the same resolution, in it.
  terrain::Grid around(const terrain::Grid& grid) const;

 private:
  std::size_t index(const Eigen::Vector2i& cell) const {
    return static_cast<std::size_t>(cell.y()) * static_cast<std::size_t>(grid_.columns) +
           static_cast<std::size_t>(cell.x());
  }

  terrain::Grid grid_;
  std::vector<Way> cells_;  // empty: nothing yet
};

}  // namespace gaitd::footsteps

#endif  // GAITD_FOOTSTEPS_WAY_MEMORY_H_
