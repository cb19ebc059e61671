// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/campaign/plan.h"
#include "cli/campaign/results.h"
#include "cli/context.h"

namespace gaitd::cli {

/// Values of the tuned parameters that are played.
struct Candidate {
  std::string name;
  std::vector<std::string> values;  ///< in the order of the parameters; empty: nothing is set
};

/// A part of a tuning: an ordinary campaign, with the candidates as values of the setting
/// `candidate`.
struct Stage {
  std::string name;   ///< of its file and its folder
  std::string title;  ///< before the bar
  std::vector<Candidate> candidates;
  bool held_out = false;  ///< plays what the candidates were not chosen by
};

struct StageResults {
  CampaignPlan plan;
  CampaignResults results;

  /// The runs of a candidate. Those of two candidates, also of two stages that play the same, are
  /// pairs: the same place is the same scenario, seed and settings.
  std::vector<const CampaignResult*> runs(const std::string& candidate) const;
};

/// How stages are played.
struct StageOptions {
  std::filesystem::path folder;  ///< of the tuning
  std::string engine = "local";
  int jobs = 1, shards = 0;
};

/// Plays what is missing of a stage. Nothing with the exit code of gaitctl in `exit_code` if it was
/// interrupted or a run could not be judged; that is told.
std::optional<StageResults> play_stage(const Context& context, const CampaignPlan& tuning,
                                       const Stage& stage, const StageOptions& options,
                                       int* exit_code);

}  // namespace gaitd::cli
