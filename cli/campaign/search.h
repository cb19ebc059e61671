// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cli/campaign/campaign.h"
#include "cli/campaign/results.h"
#include "cli/campaign/shard.h"
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
  bool at_least = false;  ///< nothing failed up to the last value: how much more is held is unknown
};

/// Which runs of a shard are to be played, in which order: all of them, or of a search those that
/// the bisection of each combination and seed asks for, which stays whole in one shard.
class RunOrder {
 public:
  RunOrder(const Campaign& campaign, const std::vector<CampaignRun>& runs,
           const CampaignResults& results, const Shard& shard = {});

  /// So many parts a campaign can be cut into.
  std::size_t lanes() const { return lanes_.size(); }
  /// The runs of the shard, those of a search that nobody asks for among them.
  std::vector<CampaignRun> runs() const;

  /// Number of a run to start now. Nothing while the results of others have to be known first, and
  /// when there is none left.
  std::optional<int> next();
  /// At most so many runs have no result yet.
  std::size_t remaining() { return remaining_of(mine_); }
  /// The same of another shard.
  std::size_t remaining(const Shard& shard) {
    return remaining_of(shard_range(shard, lanes_.size()));
  }
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
  std::size_t remaining_of(const ShardRange& range);

  const Campaign& campaign_;
  const std::vector<CampaignRun>& runs_;
  const CampaignResults& results_;
  std::vector<Lane> lanes_;  // of all shards
  ShardRange mine_;
  std::size_t first_open_ = 0;
  std::set<int> started_;
  int levels_ = 1;  // runs in a lane
  int stride_ = 1;  // between their numbers
};

}  // namespace gaitd::cli
