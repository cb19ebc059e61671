// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "cli/campaign/campaign.h"
#include "cli/campaign/results.h"
#include "cli/campaign/search.h"
#include "cli/child_pool.h"

namespace gaitd::cli {

struct RunnerOptions {
  std::filesystem::path gaitctl;       ///< plays each run, in a process of its own
  std::filesystem::path folder;        ///< of the campaign
  std::vector<std::string> settings;   ///< KEY=VALUE, over those of the campaign
  int jobs = 1;                        ///< processes at once
  bool trust = false;                  ///< load libraries that scenarios name by path
  std::filesystem::path scratch = {};  ///< where logs are written first; empty: in the folder
  std::string part = {};  ///< of a tuning: stands before the bar, and the summary is only written
};

/// What gaitctl run is given: the name of a scenario, its file, or for a kind of the gauntlet the
/// file that write_drawn() makes.
std::string scenario_of(const Campaign& campaign, const CampaignRun& run,
                        const std::filesystem::path& folder);

/// By the file of a calibration that could not be made: why.
using CalibrationFailures = std::map<std::string, std::string>;

/// KEY=VALUE of everything that a run is asked to have, later ones win.
std::vector<std::string> settings_of(const Campaign& campaign, const CampaignRun& run,
                                     const RunnerOptions& options);

/// What gaitctl run is given of them: with the calibration that was measured, where one is.
std::vector<std::string> played_settings(const Campaign& campaign, const CampaignRun& run,
                                         const RunnerOptions& options);

/// Writes the drawn scenarios of the runs into the folder of the campaign. Results of other ones
/// must not get mixed with theirs, so those that are there have to be the same.
bool write_drawn(const Campaign& campaign, const std::vector<CampaignRun>& runs,
                 const std::filesystem::path& folder, std::string* error);

/// Plays the runs that the order asks for, several at once, and appends what came of them; a run
/// whose calibration has failed is not played, and has failed too. SIGINT and SIGTERM end it; runs
/// that were under way are forgotten. `progress` is called after each run and a few times a second,
/// with the number of runs that this call has finished.
PoolEnd play_runs(const Campaign& campaign, const std::vector<CampaignRun>& runs,
                  const RunnerOptions& options, const CalibrationFailures& failures,
                  RunOrder* order, ResultFile* results,
                  const std::function<void(int finished)>& progress, std::string* error);

}  // namespace gaitd::cli
