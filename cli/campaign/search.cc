// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/search.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace gaitd::cli {

void read_search(daemon::MapReader map, Campaign* campaign) {
  if (!map.valid()) return;
  map.require({"key", "from", "to", "count"});
  const auto key = map.text("key");
  const auto from = map.number("from");
  const auto to = map.number("to");
  const auto count = map.integer("count", 2, 100000);
  map.finish();
  if (!key || !from || !to || !count) return;
  if (*from >= *to) {
    map.fail("to", "a number larger than 'from'", daemon::describe(*map.node("to")),
             "a search begins with the value that is easiest to hold");
    return;
  }
  CampaignSetting setting{*key, {}};
  for (long long i = 0; i < *count; ++i) {
    char number[32];
    std::snprintf(number, sizeof(number), "%.6g",
                  *from + (*to - *from) * static_cast<double>(i) / static_cast<double>(*count - 1));
    setting.values.emplace_back(number);
  }
  campaign->settings.push_back(std::move(setting));
  campaign->searches = true;
}

RunOrder::RunOrder(const Campaign& campaign, const std::vector<CampaignRun>& runs,
                   const CampaignResults& results, const Shard& shard)
    : campaign_(campaign), runs_(runs), results_(results) {
  const std::size_t levels = campaign.searches ? campaign.settings.back().values.size() : 1;
  levels_ = static_cast<int>(levels);
  std::size_t combinations = 1;  // without the searched setting, which expand() changes last
  for (const CampaignSetting& setting : campaign.settings) combinations *= setting.values.size();
  combinations /= levels;
  stride_ = static_cast<int>(combinations);
  for (std::size_t i = 0; i < runs.size(); i += combinations * levels) {
    for (std::size_t k = 0; k < combinations; ++k) {
      lanes_.push_back({static_cast<int>(i + k) + 1, -1, levels_, false});
    }
  }
  mine_ = shard_range(shard, lanes_.size());
  first_open_ = mine_.first;
}

std::vector<CampaignRun> RunOrder::runs() const {
  std::vector<CampaignRun> mine;
  for (std::size_t i = mine_.first; i < mine_.end; ++i) {
    for (int level = 0; level < levels_; ++level) {
      mine.push_back(runs_[static_cast<std::size_t>(lanes_[i].first + stride_ * level) - 1]);
    }
  }
  return mine;
}

int RunOrder::middle(const Lane& lane) const {
  return lane.first + stride_ * ((lane.held + lane.failed) / 2);
}

bool RunOrder::open(Lane* lane) {
  while (!lane->stuck && lane->failed - lane->held > 1) {
    const auto result = results_.find(middle(*lane));
    if (result == results_.end()) return true;
    const int place = (lane->held + lane->failed) / 2;
    lane->stuck = campaign_.searches && !result->second.problem.empty();
    if (!lane->stuck) (result->second.success ? lane->held : lane->failed) = place;
  }
  return false;
}

std::optional<int> RunOrder::next() {
  for (std::size_t i = first_open_; i < mine_.end; ++i) {
    const bool is_open = open(&lanes_[i]);
    if (!is_open && i == first_open_) ++first_open_;
    if (is_open && started_.insert(middle(lanes_[i])).second) return middle(lanes_[i]);
  }
  return std::nullopt;
}

std::size_t RunOrder::remaining_of(const ShardRange& range) {
  std::size_t count = 0;
  for (std::size_t i = range.first; i < range.end; ++i) {
    if (!open(&lanes_[i])) continue;
    count += std::bit_width(static_cast<unsigned>(lanes_[i].failed - lanes_[i].held - 1));
  }
  return count;
}

std::vector<SearchResult> RunOrder::found() {
  const std::size_t cells = lanes_.size() / campaign_.seeds.size();
  const std::vector<std::string>& levels = campaign_.settings.back().values;
  std::vector<SearchResult> results(cells);
  std::vector<int> held(cells, static_cast<int>(levels.size()));
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    const CampaignRun& run = runs_[static_cast<std::size_t>(lanes_[i].first) - 1];
    SearchResult& result = results[i % cells];
    result.scenario = run.scenario;
    result.values.assign(run.values.begin(), run.values.end() - 1);
    result.finished = result.finished && !open(&lanes_[i]) && !lanes_[i].stuck;
    held[i % cells] = std::min(held[i % cells], lanes_[i].held);
  }
  for (std::size_t k = 0; k < cells; ++k) {
    if (held[k] < 0 || !results[k].finished) continue;
    results[k].held = std::atof(levels[static_cast<std::size_t>(held[k])].c_str());
    results[k].at_least = held[k] + 1 == static_cast<int>(levels.size());
  }
  return results;
}

}  // namespace gaitd::cli
