// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "cli/campaign/plan.h"
#include "cli/campaign/results.h"

namespace gaitd::cli {

/// Every two values of each setting of few values, compared on runs that differ in nothing else:
/// {key, first, second, pairs, shares, figures}. `shares`, of falls and of failures, have McNemar's
/// p; `figures` the mean of second − first with its interval, of pairs in which neither fell. Each
/// says how many `more` pairs would decide it: 0 where it is decided, null where no difference
/// shows. Of a search nothing: it plays other runs for each value.
nlohmann::json comparisons_json(const CampaignPlan& plan, const CampaignResults& results);

}  // namespace gaitd::cli
