// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/campaign/campaign.h"
#include "cli/campaign/progress.h"
#include "cli/campaign/results.h"
#include "cli/campaign/runner.h"
#include "cli/child_pool.h"
#include "daemon/config/yaml_reader.h"

namespace gaitd::cli {

/// How the robot of a run is measured. Runs of the same robot have the same file.
struct Calibration {
  std::filesystem::path file;         ///< what is measured, in the folder of the campaign
  std::string seed;                   ///< of the robot
  std::vector<std::string> settings;  ///< KEY=VALUE of the robot and of where to start from
};

/// Reads `calibrate:`.
void read_calibrate(daemon::MapReader* root, Campaign* campaign);

/// Nothing if this run with these settings, KEY=VALUE, plays with the calibration that they name,
/// or with none.
std::optional<Calibration> calibration_of(const Campaign& campaign, const CampaignRun& run,
                                          const std::vector<std::string>& settings,
                                          const std::filesystem::path& folder);

/// The arguments of gaitctl that measure it and write `output`.
std::vector<std::string> calibrate_arguments(const Campaign& campaign,
                                             const Calibration& calibration,
                                             const std::filesystem::path& output);

/// Measures every robot that the runs without a result need and that has no file yet, each once.
/// What could not be measured goes to `failures`: by file, why. Ends like play_runs().
PoolEnd make_calibrations(const Campaign& campaign, const std::vector<CampaignRun>& runs,
                          const RunnerOptions& options, const CampaignResults& results,
                          const std::function<void(const ProgressCounts&)>& progress,
                          CalibrationFailures* failures, std::string* error);

}  // namespace gaitd::cli
