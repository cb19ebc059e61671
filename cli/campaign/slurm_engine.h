// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/campaign/plan.h"
#include "cli/campaign/runner.h"
#include "cli/context.h"

namespace gaitd::cli {

/// Plays a campaign as an array job of Slurm, each task a shard in a folder of its own, waits, and
/// puts them together in the folder of the campaign. A job that is still there is waited for; else
/// the shards that have not finished are submitted. `shards`: of a first start, 0 for the usual
/// number; of `options.jobs` so many tasks run at once, 0: as many as the cluster lets. The exit
/// code.
int play_on_slurm(const Context& context, const CampaignPlan& plan, const RunnerOptions& options,
                  int shards);

/// Whether the runs of this folder are, or were, on Slurm.
bool holds_slurm_job(const std::filesystem::path& folder);

}  // namespace gaitd::cli
