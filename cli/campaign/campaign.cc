// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/campaign.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/campaign/calibration.h"
#include "cli/campaign/groups.h"
#include "cli/campaign/plot.h"
#include "cli/campaign/search.h"
#include "cli/campaign/settings.h"
#include "cli/campaign/sweep.h"
#include "cli/campaign/tune_section.h"
#include "cli/gauntlet/gauntlet.h"
#include "cli/random_draw.h"
#include "cli/whole_file.h"
#include "daemon/config/node.h"
#include "daemon/config/paths.h"
#include "daemon/config/settings.h"
#include "daemon/config/yaml_reader.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;
using daemon::Issues;
using daemon::MapReader;
using daemon::Node;
using daemon::NodeKind;
using daemon::NodePtr;

constexpr std::size_t kMaxRuns = 1000000;

// Kinds of which each seed draws a scenario of its own.
void read_gauntlet(MapReader* root, Campaign* campaign) {
  const std::vector<std::string>& kinds = gauntlet_kinds();
  int i = 0;
  for (const NodePtr& node : root->list("gauntlet", 1, 1000)) {
    const std::string path = "gauntlet[" + std::to_string(i++) + "]";
    const bool known = std::find(kinds.begin(), kinds.end(), node->text) != kinds.end();
    if (node->kind != NodeKind::kScalar || !known) {
      root->issues()->add(node->where, path, "a kind of the gauntlet", daemon::describe(*node),
                          daemon::suggestion(node->text, kinds));
    } else if (!campaign->drawn.insert(node->text).second) {
      root->issues()->add(node->where, path, "each kind once", "'" + node->text + "' again",
                          "leave one of them out");
    } else {
      campaign->scenarios.push_back(node->text);
    }
  }
}

void read_scenarios(MapReader* root, Campaign* campaign) {
  read_gauntlet(root, campaign);
  const daemon::Paths paths = daemon::Paths::detect();
  int i = 0;
  for (const NodePtr& node : root->list("scenarios", 1, 1000)) {
    const std::string path = "scenarios[" + std::to_string(i++) + "]";
    const std::string& scenario = node->text;
    const bool there = campaign->is_copy || paths.scenario(scenario_from(campaign->file, scenario));
    if (node->kind != NodeKind::kScalar || !there || campaign->drawn.contains(scenario)) {
      root->issues()->add(node->where, path, "the name of a scenario or the path of its file",
                          daemon::describe(*node),
                          daemon::suggestion(node->text, paths.scenarios()));
      continue;
    }
    std::vector<std::string>& all = campaign->scenarios;
    if (std::find(all.begin(), all.end(), scenario) != all.end()) {
      root->issues()->add(node->where, path, "each scenario once", daemon::describe(*node),
                          "the same runs again say nothing new");
    }
    all.push_back(scenario);
  }
}

bool read_choices(MapReader map, CampaignDraw* draw) {
  for (const NodePtr& item : map.list("choose", 1, 1000)) {
    draw->choices.push_back(setting_text(*item));
  }
  map.require({"choose"});
  map.finish();
  return !draw->choices.empty();
}

void read_draws(MapReader map, Campaign* campaign) {
  for (const Node::Entry& entry : map.entries()) {
    CampaignDraw draw{entry.key, {}, {}, false, {}};
    if (entry.value->kind == NodeKind::kMap) {
      if (read_choices(map.map(entry.key), &draw)) campaign->draws.push_back(std::move(draw));
      continue;
    }
    std::vector<double>* ends[] = {&draw.low, &draw.high};
    bool fits = entry.value->kind == NodeKind::kList && entry.value->items.size() == 2;
    for (std::size_t end = 0; fits && end < 2; ++end) {
      const Node& node = *entry.value->items[end];
      draw.is_list = node.kind == NodeKind::kList;
      const std::vector<NodePtr> one{entry.value->items[end]};
      for (const NodePtr& item : draw.is_list ? node.items : one) {
        const auto number = daemon::as_number(*item);
        fits = fits && number.has_value();
        ends[end]->push_back(number.value_or(0.0));
      }
    }
    fits = fits && !draw.low.empty() && draw.low.size() == draw.high.size();
    for (std::size_t i = 0; fits && i < draw.low.size(); ++i) fits = draw.low[i] <= draw.high[i];
    if (!fits) {
      map.fail(entry.key,
               "[lowest, highest], two numbers or two lists of as many, or {choose: [values]}",
               daemon::describe(*entry.value), "for example [0.9, 1.1]");
      continue;
    }
    campaign->draws.push_back(std::move(draw));
  }
}

// A key twice, or one that the campaign itself sets, would hide one of its values.
void check_keys(MapReader* root, const Campaign& campaign) {
  std::set<std::string> seen{"seed"};
  const auto check = [&](const char* section, const std::string& key) {
    if (seen.insert(key).second) return;
    root->fail(std::string(section) + "." + key,
               "each key once, and seeds under seeds:", "'" + key + "' again",
               "leave one of them out");
  };
  for (const CampaignSetting& setting : campaign.settings) {
    const auto bundle = campaign.bundles.find(setting.key);
    if (bundle == campaign.bundles.end() || setting.key == kSweptSetting) {
      check("set", setting.key);
      continue;
    }
    std::set<std::string> keys;  // of any of its values
    for (const auto& [value, assignments] : bundle->second) {
      for (const std::string& assignment : assignments) {
        keys.insert(assignment.substr(0, assignment.find('=')));
      }
    }
    for (const std::string& key : keys) check("set", key);
  }
  for (const CampaignDraw& draw : campaign.draws) check("draw", draw.key);
  if (!campaign.tune) return;
  for (const TunedParameter& tuned : campaign.tune->parameters) {
    check("tune.parameters", tuned.key);
  }
}

std::string draw_value(const CampaignDraw& draw, std::uint64_t seed) {
  if (const std::size_t count = draw.choices.size(); count > 0) {
    const double place = uniform_draw(seed, draw.key, 0) * static_cast<double>(count);
    return draw.choices[std::min(count - 1, static_cast<std::size_t>(place))];
  }
  std::string text;
  for (std::size_t i = 0; i < draw.low.size(); ++i) {
    const double value =
        draw.low[i] + (draw.high[i] - draw.low[i]) * uniform_draw(seed, draw.key, i);
    text += (i > 0 ? ", " : "") + setting_number(value);
  }
  return draw.is_list ? "[" + text + "]" : text;
}

}  // namespace

std::string scenario_from(const std::string& campaign_file, const std::string& scenario) {
  const fs::path beside = fs::path(campaign_file).parent_path() / scenario;
  std::error_code error;
  if (scenario.ends_with(".yaml") && fs::is_regular_file(beside, error)) {
    return beside.lexically_normal().string();
  }
  return scenario;
}

std::optional<Campaign> load_campaign(const std::string& file, Issues* issues,
                                      const std::string& copy_of) {
  const std::size_t errors = issues->error_count();
  const NodePtr node = daemon::load_yaml_file(file, issues);
  if (node == nullptr) return std::nullopt;
  Campaign campaign;
  campaign.file = fs::absolute(copy_of.empty() ? file : copy_of).lexically_normal().string();
  campaign.text = read_file(file);
  campaign.is_copy = !copy_of.empty() && copy_of != file;
  MapReader root(node, "", issues);
  root.require({"schema", "name"});
  if (!root.has("gauntlet")) root.require({"scenarios"});
  constexpr std::array<std::string_view, 2> kSuccess = {"expectations", "no_fall"};
  root.schema("gaitd.campaign/1");
  campaign.name = root.text("name").value_or("");
  read_scenarios(&root, &campaign);
  read_settings(root.map("set"), &campaign);
  read_sweep(root.map("sweep"), &campaign);
  read_search(root.map("search"), &campaign);
  read_plot(root.map("plot"), &campaign);
  read_draws(root.map("draw"), &campaign);
  read_seeds(&root, &campaign);
  campaign.only_falls = root.choice("success", kSuccess).value_or(0) == 1;
  read_success_min(&root, &campaign);
  read_groups(&root, &campaign);
  campaign.keep_logs = static_cast<int>(root.integer("keep_logs", 0, 1000000).value_or(10));
  read_calibrate(&root, &campaign);
  read_tune(root.map("tune"), &campaign);
  check_keys(&root, campaign);
  root.finish();
  std::size_t runs = campaign.scenarios.size() * campaign.seeds.size();
  for (const CampaignSetting& setting : campaign.settings) {
    runs = std::min(runs * setting.values.size(), kMaxRuns + 1);
  }
  if (runs > kMaxRuns) {
    root.fail("", "at most " + std::to_string(kMaxRuns) + " runs", "more", "make it smaller");
  }
  if (issues->error_count() != errors) return std::nullopt;
  return campaign;
}

std::vector<CampaignRun> expand(const Campaign& campaign) {
  std::vector<CampaignRun> runs;
  std::size_t combinations = 1;
  for (const CampaignSetting& setting : campaign.settings) combinations *= setting.values.size();
  for (const std::uint64_t seed : campaign.seeds) {
    int cell = 0;
    for (const std::string& scenario : campaign.scenarios) {
      for (std::size_t combination = 0; combination < combinations; ++combination) {
        CampaignRun run{static_cast<int>(runs.size()) + 1, cell++, scenario, seed, {}, {}};
        std::size_t rest = combination;
        for (const CampaignSetting& setting : campaign.settings) {
          run.values.push_back(setting.values[rest % setting.values.size()]);
          rest /= setting.values.size();
        }
        for (const CampaignDraw& draw : campaign.draws) {
          run.drawn.push_back(draw_value(draw, seed));
        }
        runs.push_back(std::move(run));
      }
    }
  }
  return runs;
}

std::vector<std::string> assignments(const Campaign& campaign, const std::string& key,
                                     const std::string& value) {
  const auto bundle = campaign.bundles.find(key);
  if (bundle != campaign.bundles.end()) return bundle->second.at(value);
  return {key + "=" + value};
}

std::vector<std::string> assignments(const Campaign& campaign, const CampaignRun& run) {
  std::vector<std::string> out{"seed=" + std::to_string(run.seed)};
  for (std::size_t i = 0; i < run.values.size(); ++i) {
    for (std::string& assignment : assignments(campaign, campaign.settings[i].key, run.values[i])) {
      out.push_back(std::move(assignment));
    }
  }
  for (std::size_t i = 0; i < run.drawn.size(); ++i) {
    out.push_back(campaign.draws[i].key + "=" + run.drawn[i]);
  }
  return out;
}

}  // namespace gaitd::cli
