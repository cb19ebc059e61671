// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "cli/campaign/campaign.h"

namespace gaitd::cli {

/// What came of one run.
struct CampaignResult {
  int number = 0;  ///< of the run, from 1
  bool success = false;
  bool fell = false;
  bool refused = false;         ///< at least one of its commands
  std::string failed;           ///< expectations that do not hold, separated by spaces
  std::string problem;          ///< what kept it from being judged, one line; empty if nothing
  std::vector<double> figures;  ///< in the order of campaign_figures(); NaN: not measured
  bool damaged = false;         ///< the log; such a run has a problem, and is played again
};

/// Names of the figures that are kept of each run, as in the verdict.
const std::vector<std::string>& campaign_figures();

/// From what `gaitctl --json run` printed for that run; what is no such text becomes a problem.
CampaignResult read_result(const Campaign& campaign, int number, const std::string& run_json);

/// Of a run that was not even played, and why.
CampaignResult unjudged_result(int number, const std::string& problem);

/// How bad a run was: those that failed first, then by the largest error of the ICP.
double badness(const CampaignResult& result);

/// results.csv of a campaign: one row per finished run, in the order in which they finished.
class ResultFile {
 public:
  ResultFile(const Campaign& campaign, const std::vector<CampaignRun>& runs)
      : campaign_(campaign), runs_(runs) {}

  /// Reads the rows of an earlier start, if there are any, drops a last row that was cut off, and
  /// opens the file for more. Problems with a reason in `error`.
  bool open(const std::filesystem::path& path, std::string* error);
  bool append(const CampaignResult& result, std::string* error);

  const std::map<int, CampaignResult>& results() const { return results_; }  ///< by number

 private:
  std::string header() const;

  const Campaign& campaign_;
  const std::vector<CampaignRun>& runs_;
  std::filesystem::path path_;
  std::map<int, CampaignResult> results_;
};

/// The log of a run in the folder of its campaign.
std::filesystem::path campaign_log(const std::filesystem::path& folder, int number);

}  // namespace gaitd::cli
