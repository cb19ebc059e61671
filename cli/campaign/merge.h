// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/campaign/plan.h"
#include "cli/campaign/results.h"

namespace gaitd::cli {

/// Puts into `target`, the folder of this campaign, what was played in others: results in the order
/// of the runs, calibrations, the drawn scenarios, and the logs of the worst runs of all. What the
/// folder has stays. False with a reason in `error`: one holds another campaign, or two say
/// something else of the same run.
bool merge_folders(const CampaignPlan& plan, const std::vector<std::filesystem::path>& folders,
                   const std::filesystem::path& target, CampaignResults* results,
                   std::string* error);

}  // namespace gaitd::cli
