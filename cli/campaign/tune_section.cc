// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/tune_section.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "cli/campaign/results.h"
#include "cli/campaign/sweep.h"
#include "cli/gauntlet/gauntlet.h"
#include "daemon/config/daemon_config.h"
#include "daemon/config/paths.h"
#include "daemon/host/plugin_directory.h"
#include "daemon/parameters/reference.h"

namespace gaitd::cli {
namespace {

using daemon::LiveParameters;
using daemon::MapReader;
using daemon::Node;
using daemon::NodeKind;
using daemon::NodePtr;

constexpr int kFewestCandidates = 5;  // that CMA-ES needs
constexpr int kUsualHeldOut = 20;     // seeds

// The variant that a campaign plays of a layer, where it says which.
std::string variant_of(const Campaign& campaign, const std::string& scope) {
  for (const CampaignSetting& setting : campaign.settings) {
    if (setting.key == scope + ".variant") return setting.values.front();
  }
  const daemon::DaemonConfig usual;
  for (std::size_t i = 0; i < daemon::kLayerNames.size(); ++i) {
    if (scope == daemon::kLayerNames[i]) return usual.variants[i];
  }
  return "";
}

// A key `scope.name` is meant of the variant that plays, `scope/variant.name` of that variant.
const LiveParameters::Row* find_row(const LiveParameters& all, const Campaign& campaign,
                                    const std::string& key) {
  const std::size_t dot = key.find('.'), slash = key.find('/');
  const bool names_variant = slash < dot;
  const std::string scope = key.substr(0, std::min(slash, dot));
  const std::string variant =
      names_variant ? key.substr(slash + 1, dot - slash - 1) : variant_of(campaign, scope);
  for (int i = 0; i < all.size(); ++i) {
    const LiveParameters::Row& row = all.row(i);
    if (row.key == scope + key.substr(std::min(dot, key.size())) &&
        (row.variant.empty() || row.variant == variant)) {
      return &row;
    }
  }
  return nullptr;
}

// "30 %" or "±30 %" as a share; nothing if it is no such text.
std::optional<double> share_of(std::string text) {
  constexpr std::string_view kSign = "±";
  if (text.starts_with(kSign)) text.erase(0, kSign.size());
  if (!text.ends_with('%')) return std::nullopt;
  text.pop_back();
  char* end = nullptr;
  const double percent = std::strtod(text.c_str(), &end);
  if (end == text.c_str() ||
      text.find_first_not_of(' ', static_cast<std::size_t>(end - text.c_str())) !=
          std::string::npos)
    return std::nullopt;
  return percent > 0.0 && percent < 100.0 ? std::optional(percent / 100.0) : std::nullopt;
}

void read_parameters(MapReader map, Campaign* campaign, CampaignTune* tune) {
  LiveParameters all;
  daemon::add_all_parameters(
      daemon::PluginDirectory(daemon::Paths::detect().plugin_folders()).list(), &all);
  for (const Node::Entry& entry : map.entries()) {
    const LiveParameters::Row* row = find_row(all, *campaign, entry.key);
    if (row == nullptr || row->declared.type != GAITD_PARAMETER_REAL) {
      map.fail(entry.key, "a real parameter of the daemon or of a variant that plays",
               row == nullptr ? "no such parameter" : "a parameter of whole numbers",
               "`gaitctl param reference` lists all");
      continue;
    }
    const GaitdParameter& declared = row->declared;
    TunedParameter tuned{entry.key,       0.0, 0.0, declared.default_value, declared.minimum,
                         declared.maximum};
    const std::optional<double> share =
        entry.value->kind == NodeKind::kScalar ? share_of(entry.value->text) : std::nullopt;
    const bool list = entry.value->kind == NodeKind::kList && entry.value->items.size() == 2;
    const auto low = list ? daemon::as_number(*entry.value->items[0]) : std::nullopt;
    const auto high = list ? daemon::as_number(*entry.value->items[1]) : std::nullopt;
    if (share && tuned.usual != 0.0) {
      const double by = *share * std::abs(tuned.usual);
      tuned.low = std::max(tuned.least, tuned.usual - by);
      tuned.high = std::min(tuned.most, tuned.usual + by);
    } else if (low && high) {
      tuned.low = *low;
      tuned.high = *high;
    }
    if (tuned.low >= tuned.high || tuned.usual < tuned.low || tuned.usual > tuned.high ||
        tuned.low < tuned.least || tuned.high > tuned.most) {
      map.fail(entry.key,
               "[lowest, highest] around the default " + daemon::value_text(declared, tuned.usual) +
                   " and within " + daemon::range_text(declared) + ", or a share of the default",
               daemon::describe(*entry.value), "for example 30 %");
      continue;
    }
    tune->parameters.push_back(std::move(tuned));
  }
}

void read_objective(MapReader map, CampaignTune* tune) {
  const std::vector<std::string>& figures = campaign_figures();
  for (const Node::Entry& entry : map.entries()) {
    const auto weight = map.number(entry.key, {-1e6, 1e6, ""});
    if (std::find(figures.begin(), figures.end(), entry.key) == figures.end()) {
      map.fail(entry.key, "a figure of results.csv", "'" + entry.key + "'",
               daemon::suggestion(entry.key, figures));
    } else if (weight) {
      tune->objective.emplace_back(entry.key, *weight);
    }
  }
}

template <class Value>
bool is_among(const std::vector<Value>& values, const Value& value) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

void read_held_out(MapReader map, const Campaign& campaign, CampaignTune* tune) {
  const std::uint64_t largest = *std::max_element(campaign.seeds.begin(), campaign.seeds.end());
  const NodePtr seeds = map.node("seeds");
  if (seeds != nullptr && seeds->kind == NodeKind::kList) {
    for (const NodePtr& item : seeds->items) {
      const auto seed = daemon::as_integer(*item);
      const auto value = static_cast<std::uint64_t>(seed.value_or(0));
      if (!seed || *seed < 0 || is_among(campaign.seeds, value) ||
          is_among(tune->held_out_seeds, value)) {
        map.fail("seeds", "whole numbers, each once, that are not among 'seeds' of the campaign",
                 daemon::describe(*item), "what is tuned on is not held out");
        return;
      }
      tune->held_out_seeds.push_back(value);
    }
  } else {
    const long long count = map.integer("seeds", 1, 100000).value_or(kUsualHeldOut);
    for (long long i = 1; i <= count; ++i) {
      tune->held_out_seeds.push_back(largest + static_cast<std::uint64_t>(i));
    }
  }
  const std::vector<std::string>& kinds = gauntlet_kinds();
  for (const NodePtr& node : map.list("gauntlet", 0, 1000)) {
    if (!is_among(kinds, node->text) || campaign.drawn.contains(node->text) ||
        is_among(tune->held_out_kinds, node->text)) {
      map.fail("gauntlet", "kinds of the gauntlet, each once, that are not tuned on",
               daemon::describe(*node), daemon::suggestion(node->text, kinds));
    }
    tune->held_out_kinds.push_back(node->text);
  }
  const daemon::Paths paths = daemon::Paths::detect();
  for (const NodePtr& node : map.list("scenarios", 0, 1000)) {
    if (!campaign.is_copy && !paths.scenario(scenario_from(campaign.file, node->text))) {
      map.fail("scenarios", "the name of a scenario or the path of its file",
               daemon::describe(*node), daemon::suggestion(node->text, paths.scenarios()));
    }
    if (is_among(campaign.scenarios, node->text) ||
        is_among(tune->held_out_scenarios, node->text)) {
      map.fail("scenarios", "scenarios, each once, that are not tuned on", daemon::describe(*node),
               "what is tuned on is not held out");
    }
    tune->held_out_scenarios.push_back(node->text);
  }
  map.finish();
}

}  // namespace

void read_tune(MapReader map, Campaign* campaign) {
  if (!map.valid() || campaign->seeds.empty()) return;
  map.require({"parameters", "objective"});
  CampaignTune tune;
  const auto swept = std::any_of(campaign->settings.begin(), campaign->settings.end(),
                                 [](const auto& setting) { return setting.key == kSweptSetting; });
  if (campaign->search || swept) {
    map.fail("parameters", "a campaign without 'search' and 'sweep'", "one of them",
             "make another file for it");
  }
  read_parameters(map.map("parameters"), campaign, &tune);
  read_objective(map.map("objective"), &tune);
  tune.generations = static_cast<int>(map.integer("generations", 1, 1000).value_or(10));
  // Hansen's usual number, and what CMA-ES needs.
  const int usual = std::max(
      kFewestCandidates,
      4 + static_cast<int>(3.0 * std::log(std::max<std::size_t>(1, tune.parameters.size()))));
  tune.population =
      static_cast<int>(map.integer("population", kFewestCandidates, 1000).value_or(usual));
  tune.seed = static_cast<std::uint64_t>(map.integer("seed", 0, 1000000000).value_or(1));
  read_held_out(map.map("held_out"), *campaign, &tune);
  map.finish();
  if (tune.parameters.empty() || tune.objective.empty()) return;
  campaign->tune = std::move(tune);
}

}  // namespace gaitd::cli
