// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "daemon/goto/live_ground.h"
#include "daemon/server/rpc.h"

namespace gaitd::daemon {

/// map.put, map.clear and map.get of docs/protocol.md. `ground` outlives the server.
void add_map_methods(Methods* methods, LiveGround* ground);

/// What map.get answers: the map in cells of at least `resolution` (m), coarser where it would have
/// more than kMapCells. Of the cells that fall into one the highest counts.
nlohmann::json map_json(const LiveGround::Known& known, double resolution);
inline constexpr int kMapCells = 200'000;
inline constexpr int kTileCells = 16'384;  ///< of one map.put, at most

}  // namespace gaitd::daemon
