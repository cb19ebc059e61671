// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/campaign/campaign.h"
#include "cli/campaign/shard.h"

namespace gaitd::cli {

/// What was asked for on the command line; kept in the folder of the campaign, so that others can
/// go on from there.
struct CampaignOrigin {
  std::string file;                   ///< absolute
  std::vector<std::string> settings;  ///< KEY=VALUE of --set
  bool trust = false;                 ///< load libraries that scenarios name by path
  Shard shard;
  std::string build = {};  ///< gaitctl, gaitd and plugins that play it; filled in by the plan
};

/// A campaign as it is to be played.
struct CampaignPlan {
  CampaignOrigin origin;
  Campaign campaign;
  std::string text;                   ///< what makes this campaign, all its shards together
  std::vector<std::string> settings;  ///< of --set, those that are no settings of the campaign
  std::vector<CampaignRun> runs;      ///< of all shards
};

/// From the file that was asked for; a file that --set names by a relative path is named by the
/// whole one from then on, or as the campaign names it. Nothing with a reason in `error`.
std::optional<CampaignPlan> plan_of_file(const CampaignOrigin& asked, std::string* error);

/// From a folder that a campaign or a shard was played in, also if its scenarios have gone since.
std::optional<CampaignPlan> plan_of_folder(const std::filesystem::path& folder, std::string* error);

/// Makes the folder of a campaign and keeps others out of it while this lives.
class CampaignFolder {
 public:
  CampaignFolder() = default;
  ~CampaignFolder();
  CampaignFolder(const CampaignFolder&) = delete;
  CampaignFolder& operator=(const CampaignFolder&) = delete;

  /// False with a reason in `error`: it holds another campaign or what another build has played,
  /// another process is at work there.
  bool take(const std::filesystem::path& folder, const CampaignPlan& plan, std::string* error);

 private:
  int lock_ = -1;
};

/// Whether a campaign was ever played in this folder.
bool holds_campaign(const std::filesystem::path& folder);

}  // namespace gaitd::cli
