// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "cli/campaign/campaign.h"
#include "cli/campaign/runner.h"

namespace gaitd::cli {

/// `word` as a shell takes it.
std::string shell_word(const std::string& word);

/// The command that plays a run again, or the one that fails before it can be played. Files in the
/// folder of the campaign are named from `shown`.
std::string replay_text(const Campaign& campaign, const CampaignRun& run,
                        const RunnerOptions& options, const std::filesystem::path& shown);

}  // namespace gaitd::cli
