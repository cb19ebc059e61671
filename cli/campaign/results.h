// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
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

/// How results.csv is written: a header, and a row for each run.
class ResultFormat {
 public:
  ResultFormat(const Campaign& campaign, const std::vector<CampaignRun>& runs)
      : campaign_(campaign), runs_(runs) {}

  std::string header() const;
  std::string row(const CampaignResult& result) const;
  /// Nothing if the line is no whole row of one of the runs.
  std::optional<CampaignResult> parse(const std::string& line) const;
  /// Whether the row of this run begins like that: with its scenario, seed, settings and draws,
  /// words with or without quotes.
  bool is_of_run(const std::string& line, int number) const;

 private:
  std::vector<std::string> beginning(int number) const;  // of its row

  const Campaign& campaign_;
  const std::vector<CampaignRun>& runs_;
};

using CampaignResults = std::map<int, CampaignResult>;  ///< by the number of the run

int count_failed(const CampaignResults& results);

/// The larger the worse: those that failed, then by the largest error of the ICP.
double badness(const CampaignResult& result);

/// The worst first, by number where they are as bad.
std::vector<const CampaignResult*> worst_first(const CampaignResults& results);

/// The rows of such a file, of a run the first one. Nothing with a reason in `error` if it holds
/// those of another campaign; a file that is not there has no rows.
std::optional<CampaignResults> read_results(const std::filesystem::path& path,
                                            const ResultFormat& format, std::string* error);

/// All of them in the order of the runs, whatever the order in which they ended: the same results
/// are the same bytes. The file is replaced whole or not at all.
bool write_results(const std::filesystem::path& path, const ResultFormat& format,
                   const CampaignResults& results, std::string* error);

/// results.csv of a campaign that is being played: a row is added as each run ends.
class ResultFile {
 public:
  ResultFile(const Campaign& campaign, const std::vector<CampaignRun>& runs)
      : format_(campaign, runs) {}

  /// Reads the rows of an earlier start, if there are any, drops a last row that was cut off and
  /// those of runs that could not be judged, which are played again, and opens the file for more.
  bool open(const std::filesystem::path& path, std::string* error);
  /// Among the results from now on; in the file once it is written.
  void add(const CampaignResult& result);
  bool write(const CampaignResult& result, std::string* error) const;
  /// Puts the rows in the order of the runs.
  bool sort(std::string* error) const { return write_results(path_, format_, results_, error); }

  const CampaignResults& results() const { return results_; }
  int failed() const { return failed_; }
  /// Whether none of them could be judged.
  bool none_judged() const { return unjudged_ == static_cast<int>(results_.size()); }

 private:
  void count(const CampaignResult& result, int by);

  ResultFormat format_;
  std::filesystem::path path_;
  CampaignResults results_;
  int failed_ = 0, unjudged_ = 0;  // of the results
};

/// The log of a run in the folder of its campaign, and whether it was kept.
std::filesystem::path campaign_log(const std::filesystem::path& folder, int number);
bool has_log(const std::filesystem::path& folder, int number);
/// Whether a run left a log here, or only what gaitd printed because it ended before it had one.
bool left_files(const std::filesystem::path& log);
/// Removes the log of a run, what gaitd printed, and the columns that were made of the log.
void remove_run_files(const std::filesystem::path& log);

}  // namespace gaitd::cli
