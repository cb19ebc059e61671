// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/campaign/campaign.h"
#include "cli/campaign/search.h"
#include "daemon/config/yaml_reader.h"

namespace gaitd::cli {

/// Reads `plot:`; to be called after the settings and the search are read.
void read_plot(daemon::MapReader map, Campaign* campaign);

/// What is drawn for one combination of settings.
struct PlotPoint {
  std::string scenario;
  std::vector<std::string> values;  ///< of the settings, without the searched one
  double value = 0.0;
  std::optional<double> low, high;  ///< 95 % interval of what a search found
  bool beyond = false;              ///< the value is a bound: the limit is beyond what was tried
};

/// Of a search the limit, or what it is at least or at most where it is beyond what was tried; what
/// is not known yet is left out. Else the success rate.
std::vector<PlotPoint> plot_points(const Campaign& campaign, const std::vector<CampaignRun>& runs,
                                   const CampaignResults& results, RunOrder* order);

/// Polar diagrams of one scenario as SVG: the value over the angle, an angle of 0 upwards and
/// growing counter-clockwise, with the interval as a line across. Of settings that are not drawn
/// the least of all their values. A limit beyond what was tried has a hollow dot.
std::string polar_plot(const Campaign& campaign, const std::vector<PlotPoint>& points,
                       const std::string& scenario);

}  // namespace gaitd::cli
