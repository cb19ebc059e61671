// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/campaign/campaign.h"
#include "cli/tune/objective.h"
#include "cli/tune/stage.h"

namespace gaitd::cli {

struct PlayedCandidate {
  Candidate candidate;
  int generation = 0;  ///< from 1; the mean of the last one comes after it
  Score score;
  std::vector<bool> successes;  ///< of its runs, in their order
};

struct NeighbourOutcome {
  std::string name;
  Score score;
  int lost = 0;  ///< runs that the winner holds and it does not
};

struct TuneOutcome {
  const Campaign* campaign = nullptr;
  std::vector<PlayedCandidate> played;
  PlayedCandidate winner;  ///< without values: nothing was better than the defaults
  std::vector<NeighbourOutcome> neighbours;
  nlohmann::json held_out;  ///< as verdict_json()
};

/// candidates.csv, winner.yaml, summary.txt and summary.json in the folder of the tuning.
bool write_outcome(const TuneOutcome& outcome, const std::filesystem::path& folder,
                   std::string* error);

nlohmann::json outcome_json(const TuneOutcome& outcome, const std::filesystem::path& folder);
std::string outcome_text(const TuneOutcome& outcome, const std::filesystem::path& folder);

}  // namespace gaitd::cli
