// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/campaign/campaign.h"
#include "cli/campaign/results.h"
#include "cli/campaign/runner.h"
#include "cli/campaign/search.h"

namespace gaitd::cli {

/// Success rates by cell and by group, or what a search found, the worst runs with their logs and
/// the commands that play them again, and whether the campaign is passed; a search is if it found
/// something for every combination. Files in the folder are named from `shown`: the folder, or
/// empty for a text that stands in it.
nlohmann::json summary_json(const Campaign& campaign, const std::vector<CampaignRun>& runs,
                            const CampaignResults& results, RunOrder* order,
                            const RunnerOptions& options, const std::filesystem::path& shown);
/// Tables are at most `columns` wide; 0: no limit.
std::string summary_text(const nlohmann::json& summary, std::size_t columns);

}  // namespace gaitd::cli
