// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/campaign/plan.h"
#include "cli/campaign/results.h"
#include "cli/campaign/runner.h"
#include "cli/context.h"

namespace gaitd::cli {

/// Of what there is of a campaign: summary and plots into its folder, the summary to standard
/// output. The files name what is in the folder from there, so that it can be moved, and are the
/// same wherever the runs were played. Returns whether the campaign is passed.
bool conclude(const Context& context, const CampaignPlan& plan, const CampaignResults& results,
              const RunnerOptions& options);

}  // namespace gaitd::cli
