// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/campaign/campaign.h"
#include "cli/campaign/results.h"
#include "daemon/config/yaml_reader.h"

namespace gaitd::cli {

/// Reads `success_min`: a rate for each combination, or rates for runs with certain settings.
void read_success_min(daemon::MapReader* root, Campaign* campaign);

/// Reads `groups`: lists of settings, and `scenario`, by which the summary counts.
void read_groups(daemon::MapReader* root, Campaign* campaign);

/// Success rate with its interval for each combination of values of each group.
nlohmann::json groups_json(const Campaign& campaign, const std::vector<CampaignRun>& runs,
                           const CampaignResults& results);

/// How often the runs of each target succeeded, and whether that is enough. Those that no run is
/// about go to `without_runs`.
nlohmann::json targets_json(const Campaign& campaign, const std::vector<CampaignRun>& runs,
                            const CampaignResults& results, nlohmann::json* without_runs);

/// Both as they stand in the summary; tables are at most `columns` wide, 0: no limit.
std::string groups_text(const nlohmann::json& groups, std::size_t columns);
std::string targets_text(const nlohmann::json& targets, const nlohmann::json& without_runs);

/// A share as a percentage, with so many digits that only all of them are 100 and none of them 0.
std::string percent_text(double share);

}  // namespace gaitd::cli
