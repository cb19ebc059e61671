// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/pairs.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/campaign/labels.h"
#include "cli/campaign/statistics.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;

constexpr std::size_t kMostValues = 8;  // of a setting: 28 comparisons
constexpr double kDecided = 0.05;

using Pair = std::pair<const CampaignResult*, const CampaignResult*>;

// Runs of two values of a setting whose numbers are `stride` apart for each value.
std::vector<Pair> pairs_of(const CampaignResults& results, int combinations, int stride, int count,
                           int first, int second) {
  std::vector<Pair> pairs;
  for (const auto& [number, result] : results) {
    if ((number - 1) % combinations / stride % count != first) continue;
    const auto other = results.find(number + stride * (second - first));
    if (other == results.end()) continue;
    if (!result.problem.empty() || !other->second.problem.empty()) continue;
    pairs.emplace_back(&result, &other->second);
  }
  return pairs;
}

json more_json(bool decided, const std::optional<double>& needed, std::size_t pairs) {
  if (decided) return 0;
  if (!needed) return nullptr;
  return std::max(1.0, *needed - static_cast<double>(pairs));
}

template <typename Holds>
json share_json(const char* what, const std::vector<Pair>& pairs, const Holds& holds) {
  std::int64_t both = 0, only_first = 0, only_second = 0;
  for (const auto& [first, second] : pairs) {
    const bool a = holds(*first), b = holds(*second);
    both += a && b ? 1 : 0;
    only_first += a && !b ? 1 : 0;
    only_second += !a && b ? 1 : 0;
  }
  const double p = mcnemar(only_first, only_second);
  const auto count = static_cast<std::int64_t>(pairs.size());
  return {{"what", what},
          {"both", both},
          {"only_first", only_first},
          {"only_second", only_second},
          {"p", p},
          {"more", more_json(p < kDecided, pairs_for_shares(only_first, only_second, count),
                             pairs.size())}};
}

json figures_json(const std::string& name, const std::vector<Pair>& pairs) {
  json figures = json::array();
  for (std::size_t i = 0; i < campaign_figures().size(); ++i) {
    std::vector<double> differences;
    for (const auto& [first, second] : pairs) {
      const double difference = second->figures[i] - first->figures[i];
      if (!first->fell && !second->fell && std::isfinite(difference)) {
        differences.push_back(difference);
      }
    }
    if (differences.size() < 2) continue;
    const MeanInterval mean = bootstrap_mean(differences, name + " " + campaign_figures()[i]);
    const bool decided = mean.low > 0.0 || mean.high < 0.0;
    figures.push_back(
        {{"figure", campaign_figures()[i]},
         {"pairs", differences.size()},
         {"mean", mean.mean},
         {"low", mean.low},
         {"high", mean.high},
         {"more", more_json(decided, values_for_mean(differences), differences.size())}});
  }
  return figures;
}

}  // namespace

json comparisons_json(const CampaignPlan& plan, const CampaignResults& results) {
  json comparisons = json::array();
  if (plan.campaign.search) return comparisons;
  int combinations = 1, stride = 1;
  for (const CampaignSetting& setting : plan.campaign.settings) {
    combinations *= std::max(1, static_cast<int>(setting.values.size()));
  }
  for (const CampaignSetting& setting : plan.campaign.settings) {
    const int count = std::max(1, static_cast<int>(setting.values.size()));
    for (int a = 0; a < count && setting.values.size() <= kMostValues; ++a) {
      for (int b = a + 1; b < count; ++b) {
        const std::vector<Pair> pairs = pairs_of(results, combinations, stride, count, a, b);
        if (pairs.empty()) continue;
        const auto label = [&](int place) {
          return value_label(plan.campaign, setting.key,
                             setting.values[static_cast<std::size_t>(place)]);
        };
        const std::string name = setting.key + " " + label(a) + " " + label(b);
        comparisons.push_back(
            {{"key", setting.key},
             {"first", label(a)},
             {"second", label(b)},
             {"pairs", pairs.size()},
             {"shares",
              {share_json("falls", pairs, [](const CampaignResult& r) { return r.fell; }),
               share_json("failures", pairs, [](const CampaignResult& r) { return !r.success; })}},
             {"figures", figures_json(name, pairs)}});
      }
    }
    stride *= count;
  }
  return comparisons;
}

}  // namespace gaitd::cli
