// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "cli/campaign/campaign.h"
#include "cli/campaign/limit.h"
#include "cli/campaign/results.h"
#include "cli/campaign/shard.h"
#include "daemon/config/yaml_reader.h"

namespace gaitd::cli {

/// Reads `search:`, evenly spaced values of one key, as the last setting of the campaign.
void read_search(daemon::MapReader map, Campaign* campaign);

/// Reads `seeds:`; to be called after the search is read, which plays each seed once.
void read_seeds(daemon::MapReader* root, Campaign* campaign);

/// What a search found for one combination of the other settings.
struct SearchResult {
  std::string scenario;
  std::vector<std::string> values;  ///< of the other settings, in their order
  int runs = 0, successes = 0;
  bool finished = true;
  /// Of the searched key: the median of where the limit may be, and the 95 % interval around it.
  /// What is beyond the values that were tried is nothing.
  std::optional<double> limit, low, high;
};

/// Which runs of a shard are to be played, in which order: all of them, or of a search those that
/// each combination asks for next. A combination is searched whole in one shard, and what it asks
/// for depends on its results alone, not on how many runs go on at once.
class RunOrder {
 public:
  RunOrder(const Campaign& campaign, const std::vector<CampaignRun>& runs,
           const CampaignResults& results, const Shard& shard = {});

  /// So many parts a campaign can be cut into: runs, or combinations that are searched.
  std::size_t parts() const { return campaign_.search ? searches_.size() : runs_.size(); }
  /// The runs of the shard, those of a search that nobody asks for among them.
  std::vector<CampaignRun> runs() const;

  /// Number of a run to start now. Nothing while the results of others have to be known first, and
  /// when there is none left.
  std::optional<int> next();
  /// At most so many runs have no result yet. From the first call on, results of other runs of this
  /// shard may come, and none may go.
  std::size_t remaining();
  /// The same of another shard.
  std::size_t remaining(const Shard& shard) { return remaining_of(shard_range(shard, parts())); }
  /// Of a search, in the order of scenarios and combinations.
  std::vector<SearchResult> found();

 private:
  // Of one combination of the other settings.
  struct Search {
    int first = 0;              // number of the run with the first seed at the first level
    std::vector<Trial> trials;  // whose results are known
    std::vector<int> asked;     // numbers of the runs that come next, all at once
    double low = 0.0, limit = 0.0, high = 1.0;  // by places, as LimitPosterior
    bool ended = false;
    bool stuck = false;  // a run could not be judged
  };

  int number_of(const Search& search, std::size_t seed, int level) const {
    return search.first + static_cast<int>(seed) * per_seed_ + level * stride_;
  }
  std::span<const int> asked(std::size_t part) const;
  bool open(std::size_t part);  // after the results that there are
  void take_results(Search* search) const;
  void ask_more(Search* search) const;
  std::size_t remaining_of(const ShardRange& range);
  SearchResult result_of(const Search& search) const;

  const Campaign& campaign_;
  const std::vector<CampaignRun>& runs_;
  const CampaignResults& results_;
  std::optional<LimitModel> model_;
  std::vector<Search> searches_;  // of all shards; empty without a search
  ShardRange mine_;
  std::size_t first_open_ = 0;
  std::set<int> started_;
  std::size_t remaining_ = 0;           // when there were counted_ results
  std::optional<std::size_t> counted_;  // nothing: never
  int levels_ = 1;
  int stride_ = 1;    // between the numbers of two levels
  int per_seed_ = 1;  // between those of two seeds
};

}  // namespace gaitd::cli
