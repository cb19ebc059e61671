// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "cli/campaign/plan.h"
#include "cli/campaign/results.h"
#include "cli/campaign/runner.h"

namespace gaitd::cli {

/// Everything that the page of a campaign shows, but for comparisons and what logs say: summary,
/// rates by each setting and by each two of them, quantiles of the figures, rates over what was
/// drawn, and the runs themselves, of many those that failed and an even sample of the others.
nlohmann::json page_data(const CampaignPlan& plan, const CampaignResults& results,
                         const RunnerOptions& options);

}  // namespace gaitd::cli
