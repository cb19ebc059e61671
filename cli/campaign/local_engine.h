// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/campaign/plan.h"
#include "cli/campaign/runner.h"
#include "cli/context.h"

namespace gaitd::cli {

/// Plays a campaign, or its shard, on this machine and says what came of it. The exit code: of a
/// shard 0 once all its runs are played, whatever came of them.
int play_locally(const Context& context, const CampaignPlan& plan, const RunnerOptions& options);

}  // namespace gaitd::cli
