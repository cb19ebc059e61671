// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/page_data.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cli/campaign/labels.h"
#include "cli/campaign/plot.h"
#include "cli/campaign/replay_text.h"
#include "cli/campaign/search.h"
#include "cli/campaign/statistics.h"
#include "cli/campaign/summary.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kMostRuns = 4000;  // on the page, some hundred bytes each
constexpr std::size_t kBins = 8;         // of what was drawn

// One thing that differs between runs: the scenario, or a setting.
struct Axis {
  std::string key;
  std::vector<std::string> labels;
  std::vector<int> place;  // of each run, by its number - 1
};

std::vector<Axis> axes_of(const CampaignPlan& plan) {
  const auto place_in = [](const std::vector<std::string>& values, const std::string& value) {
    return static_cast<int>(std::find(values.begin(), values.end(), value) - values.begin());
  };
  std::vector<Axis> axes{{"scenario", plan.campaign.scenarios, {}}};
  for (const CampaignRun& run : plan.runs) {
    axes[0].place.push_back(place_in(plan.campaign.scenarios, run.scenario));
  }
  for (std::size_t i = 0; i < plan.campaign.settings.size(); ++i) {
    const CampaignSetting& setting = plan.campaign.settings[i];
    Axis axis{setting.key, {}, {}};
    for (const std::string& value : setting.values) {
      axis.labels.push_back(value_label(plan.campaign, setting.key, value));
    }
    for (const CampaignRun& run : plan.runs) {
      axis.place.push_back(place_in(setting.values, run.values[i]));
    }
    axes.push_back(std::move(axis));
  }
  return axes;
}

struct Outcomes {
  int runs = 0, successes = 0, falls = 0;

  void add(const CampaignResult& result) {
    ++runs;
    successes += result.success ? 1 : 0;
    falls += result.fell ? 1 : 0;
  }
  json to_json() const {
    const SuccessInterval interval = wilson_interval(successes, runs);
    return {{"runs", runs},
            {"successes", successes},
            {"falls", falls},
            {"low", interval.low},
            {"high", interval.high}};
  }
};

std::size_t index_of(const CampaignResult& result) {
  return static_cast<std::size_t>(result.number) - 1;
}

json quantiles(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  json out = json::array();
  for (const double share : {0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0}) {
    out.push_back(values[static_cast<std::size_t>(
        std::lround(share * static_cast<double>(values.size() - 1)))]);
  }
  return out;
}

// By each value of an axis: how often, and how the figures are spread.
json axis_json(const Axis& axis, const CampaignResults& results) {
  std::vector<Outcomes> counts(axis.labels.size());
  const std::size_t figures = campaign_figures().size();
  std::vector<std::vector<std::vector<double>>> values(axis.labels.size(),
                                                       std::vector<std::vector<double>>(figures));
  for (const auto& [number, result] : results) {
    const auto place = static_cast<std::size_t>(axis.place[index_of(result)]);
    counts[place].add(result);
    for (std::size_t i = 0; i < figures; ++i) {
      if (std::isfinite(result.figures[i])) values[place][i].push_back(result.figures[i]);
    }
  }
  json rows = json::array();
  for (std::size_t k = 0; k < axis.labels.size(); ++k) {
    json row = counts[k].to_json();
    for (const std::vector<double>& of : values[k]) {
      row["figures"].push_back(of.empty() ? json() : quantiles(of));
    }
    rows.push_back(std::move(row));
  }
  return {{"key", axis.key}, {"labels", axis.labels}, {"rows", rows}};
}

json maps_json(const std::vector<Axis>& axes, const CampaignResults& results) {
  constexpr std::size_t kMostValues = 60;  // of a side that can still be read
  json maps = json::array();
  for (std::size_t a = 0; a < axes.size(); ++a) {
    for (std::size_t b = a + 1; b < axes.size(); ++b) {
      const std::size_t rows = axes[a].labels.size(), columns = axes[b].labels.size();
      if (rows < 2 || columns < 2 || rows > kMostValues || columns > kMostValues) continue;
      std::vector<Outcomes> counts(rows * columns);
      for (const auto& [number, result] : results) {
        const std::size_t i = index_of(result);
        counts[static_cast<std::size_t>(axes[a].place[i]) * columns +
               static_cast<std::size_t>(axes[b].place[i])]
            .add(result);
      }
      json cells = json::array();
      for (const Outcomes& count : counts) cells.push_back({count.successes, count.runs});
      maps.push_back({{"rows", a}, {"columns", b}, {"cells", cells}});
    }
  }
  return maps;
}

// Of numbers that were drawn: rates in bins of as many runs each.
json drawn_json(const CampaignPlan& plan, const CampaignResults& results) {
  json drawn = json::array();
  for (std::size_t i = 0; i < plan.campaign.draws.size(); ++i) {
    const CampaignDraw& draw = plan.campaign.draws[i];
    if (draw.is_list || !draw.choices.empty()) continue;
    std::vector<std::pair<double, const CampaignResult*>> values;
    for (const auto& [number, result] : results) {
      values.emplace_back(std::atof(plan.runs[index_of(result)].drawn[i].c_str()), &result);
    }
    std::sort(values.begin(), values.end(), [](const auto& a, const auto& b) {
      return std::pair(a.first, a.second->number) < std::pair(b.first, b.second->number);
    });
    json bins = json::array();
    std::size_t end = 0;
    for (std::size_t bin = 1; bin <= kBins; ++bin) {
      const std::size_t first = end;
      end = std::max(end, values.size() * bin / kBins);
      // A seed draws the same in all its runs: they stay together.
      while (end > 0 && end < values.size() && values[end].first == values[end - 1].first) ++end;
      if (first == end) continue;
      Outcomes count;
      for (std::size_t k = first; k < end; ++k) count.add(*values[k].second);
      json entry = count.to_json();
      entry["from"] = values[first].first;
      entry["to"] = values[end - 1].first;
      bins.push_back(std::move(entry));
    }
    drawn.push_back({{"key", draw.key}, {"draw", i}, {"bins", bins}});
  }
  return drawn;
}

std::size_t seeds_of(const CampaignPlan& plan, const CampaignResults& results) {
  std::set<std::uint64_t> seeds;
  for (const auto& [number, result] : results) seeds.insert(plan.runs[index_of(result)].seed);
  return seeds.size();
}

std::set<int> shown_runs(const CampaignResults& results) {
  std::set<int> shown;
  std::vector<int> good;
  for (const CampaignResult* result : worst_first(results)) {
    if (!result->success && shown.size() < kMostRuns) shown.insert(result->number);
  }
  for (const auto& [number, result] : results) {
    if (result.success) good.push_back(number);
  }
  const std::size_t room = std::min(kMostRuns - shown.size(), good.size());
  for (std::size_t k = 0; k < room; ++k) shown.insert(good[k * good.size() / room]);
  return shown;
}

json run_json(const CampaignPlan& plan, const std::vector<Axis>& axes, const CampaignResult& result,
              const RunnerOptions& options) {
  const CampaignRun& run = plan.runs[index_of(result)];
  json places = json::array(), figures = json::array();
  for (const Axis& axis : axes) places.push_back(axis.place[index_of(result)]);
  for (const double figure : result.figures) {
    figures.push_back(std::isfinite(figure) ? json(figure) : json());
  }
  return {{"run", result.number},
          {"seed", run.seed},
          {"places", places},
          {"drawn", run.drawn},
          {"success", result.success},
          {"fell", result.fell},
          {"refused", result.refused},
          {"failed", result.failed},
          {"problem", result.problem},
          {"figures", figures},
          {"replay", replay_text(plan.campaign, run, options, fs::path())}};
}

}  // namespace

json page_data(const CampaignPlan& plan, const CampaignResults& results,
               const RunnerOptions& options) {
  RunOrder order(plan.campaign, plan.runs, results);
  const std::vector<Axis> axes = axes_of(plan);
  json data = {{"summary", summary_json(plan.campaign, plan.runs, results, &order, options, {})},
               {"figures", campaign_figures()},
               {"maps", maps_json(axes, results)},
               {"drawn", drawn_json(plan, results)},
               {"axes", json::array()},
               {"draws", json::array()},
               {"runs", json::array()},
               {"seeds", seeds_of(plan, results)},
               {"polar", json::array()}};
  for (const Axis& axis : axes) data["axes"].push_back(axis_json(axis, results));
  for (const CampaignDraw& draw : plan.campaign.draws) data["draws"].push_back(draw.key);
  for (const int number : shown_runs(results)) {
    data["runs"].push_back(run_json(plan, axes, results.at(number), options));
  }
  if (plan.campaign.plot) {
    const auto points = plot_points(plan.campaign, plan.runs, results, &order);
    for (const std::string& scenario : plan.campaign.scenarios) {
      data["polar"].push_back(
          {{"scenario", scenario}, {"svg", polar_plot(plan.campaign, points, scenario)}});
    }
  }
  return data;
}

}  // namespace gaitd::cli
