// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/campaign/plan.h"
#include "cli/context.h"
#include "cli/tune/stage.h"

namespace gaitd::cli {

/// Plays the generations of a tuning, the neighbours of its winner and what is held out, and says
/// whether the winner is better there. What was played is kept, so that the same call goes on.
/// The exit code of gaitctl: 0 if it is better and no neighbour loses a run that the winner holds.
int tune(const Context& context, const CampaignPlan& plan, const StageOptions& options);

}  // namespace gaitd::cli
