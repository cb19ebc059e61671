// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/search.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

#include "cli/campaign/settings.h"

namespace gaitd::cli {
namespace {

using daemon::MapReader;
using daemon::NodeKind;
using daemon::NodePtr;

constexpr int kFewestLevels = 11, kMostLevels = 200, kUsualLevels = 51;
constexpr int kFewestSeeds = 8, kUsualSeeds = 40;
// Runs that are chosen together: as many may go on at once, and the fewer they are the more each of
// them tells.
constexpr int kBatch = 4;
constexpr double kTail = 0.025;  // on either side of the interval

}  // namespace

void read_search(MapReader map, Campaign* campaign) {
  if (!map.valid()) return;
  map.require({"key", "from", "to"});
  const auto key = map.text("key");
  const auto from = map.number("from");
  const auto to = map.number("to");
  const auto count = map.integer("count", kFewestLevels, kMostLevels).value_or(kUsualLevels);
  const auto rate =
      map.number("rate", {LimitModel::kLowestRate, LimitModel::kHighestRate, ""}).value_or(0.5);
  const auto width = map.number("width");
  map.finish();
  if (!key || !from || !to) return;
  if (*from == *to) {
    map.fail("to", "another number than 'from'", daemon::describe(*map.node("to")),
             "a search goes from the value that is easiest to hold to the hardest");
    return;
  }
  const double range = std::abs(*to - *from);
  const double step = range / static_cast<double>(count - 1);
  if (width && (*width < step || *width > range)) {
    map.fail("width",
             "a width of the interval between " + setting_number(step) +
                 ", the step from value to value, and " + setting_number(range),
             daemon::describe(*map.node("width")), "a larger 'count' makes the step smaller");
    return;
  }
  CampaignSetting setting{*key, {}};
  for (long long i = 0; i < count; ++i) {
    setting.values.push_back(setting_number(*from + (*to - *from) * static_cast<double>(i) /
                                                        static_cast<double>(count - 1)));
  }
  campaign->settings.push_back(std::move(setting));
  campaign->search = {*from, *to, rate, width.value_or(range / 10.0)};
}

void read_seeds(MapReader* root, Campaign* campaign) {
  const NodePtr node = root->node("seeds");
  if (node != nullptr && node->kind == NodeKind::kList) {
    for (const NodePtr& item : node->items) {
      const auto seed = daemon::as_integer(*item);
      std::vector<std::uint64_t>& seeds = campaign->seeds;
      if (!seed || *seed < 0) {
        root->issues()->add(item->where, "seeds", "whole numbers of at least 0",
                            daemon::describe(*item), "");
        continue;
      }
      const auto value = static_cast<std::uint64_t>(*seed);
      if (std::find(seeds.begin(), seeds.end(), value) != seeds.end()) {
        root->issues()->add(item->where, "seeds", "each seed once", daemon::describe(*item),
                            "the same run again says nothing new");
      }
      seeds.push_back(value);
    }
    if (node->items.empty()) root->fail("seeds", "at least one", "none", "write how many");
  } else {
    const long long usual = campaign->search ? kUsualSeeds : 1;
    const long long count = root->integer("seeds", 1, 1000000).value_or(usual);
    for (long long i = 1; i <= count; ++i) {
      campaign->seeds.push_back(static_cast<std::uint64_t>(i));
    }
  }
  if (campaign->search && campaign->seeds.size() < kFewestSeeds) {
    root->fail("seeds", "at least " + std::to_string(kFewestSeeds) + " with 'search'",
               std::to_string(campaign->seeds.size()),
               "each run of a search has a seed of its own, and there are no more runs than seeds");
  }
}

RunOrder::RunOrder(const Campaign& campaign, const std::vector<CampaignRun>& runs,
                   const CampaignResults& results, const Shard& shard)
    : campaign_(campaign), runs_(runs), results_(results) {
  if (campaign.search) {
    levels_ = static_cast<int>(campaign.settings.back().values.size());
    model_.emplace(levels_, campaign.search->rate);
    for (const CampaignSetting& setting : campaign.settings) {
      stride_ *= static_cast<int>(setting.values.size());
    }
    stride_ /= levels_;  // the searched setting, which expand() changes last
    per_seed_ = static_cast<int>(runs.size() / campaign.seeds.size());
    for (int first = 1; first <= per_seed_; first += stride_ * levels_) {
      for (int k = 0; k < stride_; ++k) {
        searches_.emplace_back().first = first + k;
        ask_more(&searches_.back());
      }
    }
  }
  mine_ = shard_range(shard, parts());
  first_open_ = mine_.first;
}

std::vector<CampaignRun> RunOrder::runs() const {
  std::vector<CampaignRun> mine;
  for (std::size_t i = mine_.first; i < mine_.end; ++i) {
    if (!campaign_.search) {
      mine.push_back(runs_[i]);
      continue;
    }
    for (std::size_t seed = 0; seed < campaign_.seeds.size(); ++seed) {
      for (int level = 0; level < levels_; ++level) {
        mine.push_back(runs_[static_cast<std::size_t>(number_of(searches_[i], seed, level)) - 1]);
      }
    }
  }
  return mine;
}

std::span<const int> RunOrder::asked(std::size_t part) const {
  if (campaign_.search) return searches_[part].asked;
  return {&runs_[part].number, 1};
}

// The next batch, each run with the next seed; none if the interval is narrow enough or there are
// no more seeds.
void RunOrder::ask_more(Search* search) const {
  const LimitPosterior posterior = model_->posterior(search->trials);
  search->low = posterior.quantile(kTail);
  search->limit = posterior.quantile(0.5);
  search->high = posterior.quantile(1.0 - kTail);
  const CampaignSearch& asked = *campaign_.search;
  const double width = std::clamp(search->high, 0.0, 1.0) - std::clamp(search->low, 0.0, 1.0);
  const std::size_t seed = search->trials.size(), left = campaign_.seeds.size() - seed;
  search->asked.clear();
  search->ended = left == 0 || (seed > 0 && width * std::abs(asked.to - asked.from) <= asked.width);
  if (search->ended) return;
  for (const int level : model_->next_levels(posterior, std::min<int>(kBatch, left))) {
    search->asked.push_back(number_of(*search, seed + search->asked.size(), level));
  }
}

// Of the batch that was asked for, all of which has results.
void RunOrder::take_results(Search* search) const {
  for (const int number : search->asked) {
    const CampaignResult& result = results_.at(number);
    search->stuck = search->stuck || !result.problem.empty();
    search->trials.push_back({(number - search->first) % per_seed_ / stride_, result.success});
  }
  search->ended = search->stuck;
  if (!search->ended) ask_more(search);
}

bool RunOrder::open(std::size_t part) {
  const auto missing = [&] {
    const std::span<const int> numbers = asked(part);
    return std::any_of(numbers.begin(), numbers.end(),
                       [&](int number) { return !results_.contains(number); });
  };
  while (campaign_.search && !searches_[part].ended && !missing()) take_results(&searches_[part]);
  return campaign_.search ? !searches_[part].ended : missing();
}

std::optional<int> RunOrder::next() {
  for (std::size_t i = first_open_; i < mine_.end; ++i) {
    if (!open(i)) {
      if (i == first_open_) ++first_open_;
      continue;
    }
    for (const int number : asked(i)) {
      if (!results_.contains(number) && started_.insert(number).second) return number;
    }
  }
  return std::nullopt;
}

// After every run of many somebody asks.
std::size_t RunOrder::remaining() {
  if (campaign_.search || !counted_) {
    remaining_ = remaining_of(mine_);
  } else {
    remaining_ -= results_.size() - *counted_;
  }
  counted_ = results_.size();
  return remaining_;
}

std::size_t RunOrder::remaining_of(const ShardRange& range) {
  std::size_t count = 0;
  for (std::size_t i = range.first; i < range.end; ++i) {
    if (!open(i)) continue;
    count += 1;
    if (!campaign_.search) continue;
    const std::vector<int>& numbers = searches_[i].asked;
    count += campaign_.seeds.size() - searches_[i].trials.size() - 1;
    count -= static_cast<std::size_t>(std::count_if(
        numbers.begin(), numbers.end(), [&](int number) { return results_.contains(number); }));
  }
  return count;
}

SearchResult RunOrder::result_of(const Search& search) const {
  const CampaignRun& run = runs_[static_cast<std::size_t>(search.first) - 1];
  SearchResult result;
  result.scenario = run.scenario;
  result.values.assign(run.values.begin(), run.values.end() - 1);
  result.runs = static_cast<int>(search.trials.size());
  result.successes =
      static_cast<int>(std::count_if(search.trials.begin(), search.trials.end(),
                                     [](const Trial& trial) { return trial.success; }));
  result.finished = search.ended && !search.stuck;
  const double from = campaign_.search->from, to = campaign_.search->to;
  const auto value = [&](double place) {
    return std::atof(setting_number(from + (to - from) * std::clamp(place, 0.0, 1.0)).c_str());
  };
  if (search.low > 0.0) result.low = value(search.low);
  if (search.high < 1.0) result.high = value(search.high);
  if (search.limit > 0.0 && search.limit < 1.0) result.limit = value(search.limit);
  if (to < from) std::swap(result.low, result.high);
  return result;
}

std::vector<SearchResult> RunOrder::found() {
  std::vector<SearchResult> results;
  for (std::size_t i = 0; i < searches_.size(); ++i) {
    open(i);
    results.push_back(result_of(searches_[i]));
  }
  return results;
}

}  // namespace gaitd::cli
