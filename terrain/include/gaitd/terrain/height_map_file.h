// SPDX-License-Identifier: Apache-2.0
// Height maps on disk: a 16 bit grey PNG with a YAML file beside it, as map servers have them.
#ifndef GAITD_TERRAIN_HEIGHT_MAP_FILE_H_
#define GAITD_TERRAIN_HEIGHT_MAP_FILE_H_

#include <optional>
#include <string>

#include "gaitd/terrain/height_map.h"

namespace gaitd::terrain {

// Reads the map that the YAML file `file` describes. Nothing on failure; then `error` has every
// mistake, one per line: file, key, expected, got. docs/goto.md tells the format.
std::optional<HeightMap> load_height_map(const std::string& file, std::string* error);

// Writes `map` as `file`, which ends in .yaml, and images beside it: NAME.png, and
// NAME-variance.png where a variance is not zero. Heights are rounded to 65534 steps between the
// lowest and the highest, variances likewise. "" or what is wrong.
std::string save_height_map(const HeightMap& map, const std::string& file);

}  // namespace gaitd::terrain

#endif  // GAITD_TERRAIN_HEIGHT_MAP_FILE_H_
