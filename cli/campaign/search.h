// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cli/campaign/campaign.h"
#include "cli/campaign/results.h"
#include "daemon/config/yaml_reader.h"

namespace gaitd::cli {

/// Reads `search:`, evenly spaced values of one key, as the last setting of the campaign.
void read_search(daemon::MapReader map, Campaign* campaign);

/// What a search found for one combination of the other settings.
struct SearchResult {
  std::string scenario;
  std::vector<std::string> values;  ///< of the other settings, in their order
  bool finished = true;
  /// The largest value with which every seed succeeds, if there is one and as long as the larger
  /// ones are taken to fail.
  std::optional<double> held;
};

/// Which runs are to be played, in which order: all of them, or of a search those that the
/// bisection of each combination and seed asks for.
class RunOrder {
 public:
  RunOrder(const Campaign& campaign, const std::vector<CampaignRun>& runs,
           const std::map<int, CampaignResult>& results);

  /// Number of a run to start now. Nothing while the results of others have to be known first, and
  /// when there is none left.
  std::optional<int> next();
  /// At most so many runs have no result yet.
  std::size_t remaining();
  /// Of a search, in the order of scenarios and combinations.
  std::vector<SearchResult> found();

 private:
  // The runs of one combination and seed, by the searched value; without a search a single one.
  struct Lane {
    int first = 0;       // number of the run with the smallest value
    int held = -1;       // the largest value that is known to succeed, by its place
    int failed = 0;      // the smallest one that is known to fail
    bool stuck = false;  // a run could not be judged
  };

  int middle(const Lane& lane) const;  // number of the run that is asked for
  bool open(Lane* lane);               // after the results that there are

  const Campaign& campaign_;
  const std::vector<CampaignRun>& runs_;
  const std::map<int, CampaignResult>& results_;
  std::vector<Lane> lanes_;
  std::size_t first_open_ = 0;
  std::set<int> started_;
  int stride_ = 1;  // between the numbers of runs of a lane
};

}  // namespace gaitd::cli
