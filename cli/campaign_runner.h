// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "cli/campaign.h"
#include "cli/campaign_results.h"
#include "cli/campaign_search.h"

namespace gaitd::cli {

struct RunnerOptions {
  std::filesystem::path gaitctl;      ///< plays each run, in a process of its own
  std::filesystem::path folder;       ///< of the campaign
  std::vector<std::string> settings;  ///< KEY=VALUE, over those of the campaign
  int jobs = 1;                       ///< processes at once
  bool trust = false;                 ///< load libraries that scenarios name by path
};

enum class RunnerEnd { kDone, kInterrupted, kFailed };

/// Plays the runs that the order asks for, several at once, and appends what came of them. SIGINT
/// and SIGTERM end it; runs that were under way are forgotten. `progress` is called after each run
/// and a few times a second, with the number of runs that this call has finished.
RunnerEnd play_runs(const Campaign& campaign, const std::vector<CampaignRun>& runs,
                    const RunnerOptions& options, RunOrder* order, ResultFile* results,
                    const std::function<void(int finished)>& progress, std::string* error);

}  // namespace gaitd::cli
