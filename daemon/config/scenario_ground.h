// SPDX-License-Identifier: Apache-2.0
// The ground of a scenario as footsteps are planned on it.
#pragma once

#include <memory>

#include "daemon/config/scenario.h"
#include "gaitd/terrain/height_map.h"

namespace gaitd::daemon {

// The true heights of the terrain, boxes and all, around the start, the goals of the commands and
// everything there is. Null: it is a plane. Cells are those of terrain.height_map, or of 2 cm,
// coarser where there would be more than four million of them.
std::shared_ptr<const terrain::HeightMap> ground_map(const Scenario& scenario);

}  // namespace gaitd::daemon
