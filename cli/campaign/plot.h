// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/campaign/campaign.h"
#include "cli/campaign/search.h"
#include "daemon/config/yaml_reader.h"

namespace gaitd::cli {

/// Reads `plot:`; to be called after the settings and the search are read.
void read_plot(daemon::MapReader map, Campaign* campaign);

/// Polar diagrams of one scenario as SVG: the searched value that was held over the angle, an angle
/// of 0 upwards and growing counter-clockwise. What no value was held for is at the centre; what is
/// not known yet is left out.
std::string polar_plot(const Campaign& campaign, const std::vector<SearchResult>& results,
                       const std::string& scenario);

}  // namespace gaitd::cli
