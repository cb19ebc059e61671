// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/groups.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "cli/campaign/labels.h"
#include "cli/campaign/settings.h"
#include "cli/campaign/statistics.h"
#include "cli/print.h"
#include "cli/table.h"

namespace gaitd::cli {
namespace {

using daemon::MapReader;
using daemon::Node;
using daemon::NodeKind;
using daemon::NodePtr;
using nlohmann::json;

constexpr const char* kScenario = "scenario";

struct Count {
  int cell = 0;  // the first of them: rows come in the order of the cells
  int runs = 0, successes = 0, falls = 0, refusals = 0;
};

const CampaignSetting* find_setting(const Campaign& campaign, const std::string& key) {
  for (const CampaignSetting& setting : campaign.settings) {
    if (setting.key == key) return &setting;
  }
  return nullptr;
}

std::string value_of(const Campaign& campaign, const CampaignRun& run, const std::string& key) {
  if (key == kScenario) return run.scenario;
  for (std::size_t i = 0; i < run.values.size(); ++i) {
    if (campaign.settings[i].key == key) return run.values[i];
  }
  return "";
}

const CampaignRun& run_of(const std::vector<CampaignRun>& runs, int number) {
  return runs[static_cast<std::size_t>(number) - 1];
}

void read_target(MapReader map, Campaign* campaign) {
  map.require({"where", "rate"});
  CampaignTarget target;
  target.rate = map.number("rate", {0.0, 1.0, ""}).value_or(1.0);
  MapReader where = map.map("where");
  for (const Node::Entry& entry : where.entries()) {
    const CampaignSetting* setting = find_setting(*campaign, entry.key);
    const std::vector<std::string> none;
    const std::vector<std::string>& values = setting == nullptr ? none : setting->values;
    const std::string value =
        campaign->bundles.contains(entry.key) ? entry.value->text : setting_text(*entry.value);
    if (std::find(values.begin(), values.end(), value) == values.end()) {
      where.fail(entry.key, "a key of 'set' and one of its values", daemon::describe(*entry.value),
                 "");
    }
    target.where.emplace_back(entry.key, value);
  }
  map.finish();
  campaign->targets.push_back(std::move(target));
}

json count_json(const Count& count) {
  const SuccessInterval interval = wilson_interval(count.successes, count.runs);
  return {{"runs", count.runs},
          {"successes", count.successes},
          {"falls", count.falls},
          {"refusals", count.refusals},
          {"success_rate", static_cast<double>(count.successes) / count.runs},
          {"low", interval.low},
          {"high", interval.high}};
}

std::string interval_text(const json& count) {
  return percent_text(count["low"]) + " .. " + percent_text(count["high"]);
}

std::string share_text(const json& count) {
  return count["successes"].dump() + "/" + count["runs"].dump();
}

std::string where_text(const json& target) {
  std::string text;
  for (const auto& [key, value] : target["where"].items()) {
    text.append(key).append("=").append(value.get<std::string>()).append(" ");
  }
  return text;
}

}  // namespace

void read_success_min(MapReader* root, Campaign* campaign) {
  const NodePtr node = root->node("success_min");
  if (node == nullptr || node->kind != NodeKind::kList) {
    campaign->success_min = root->number("success_min", {0.0, 1.0, ""}).value_or(1.0);
    return;
  }
  campaign->success_min = 0.0;
  int i = 0;
  for (const NodePtr& item : root->list("success_min", 1, 1000)) {
    read_target(MapReader(item, "success_min[" + std::to_string(i++) + "]", root->issues()),
                campaign);
  }
}

void read_groups(MapReader* root, Campaign* campaign) {
  if (!root->has("groups")) return;
  int i = 0;
  for (const NodePtr& node : root->list("groups", 1, 100)) {
    const std::string path = "groups[" + std::to_string(i++) + "]";
    std::vector<std::string> keys;
    for (const NodePtr& item : node->items) {
      if (item->text == kScenario || find_setting(*campaign, item->text) != nullptr) {
        keys.push_back(item->text);
      }
    }
    if (keys.empty() || keys.size() != node->items.size()) {
      root->issues()->add(node->where, path, "a list of keys of 'set', and 'scenario'",
                          daemon::describe(*node), "for example [scenario]");
    }
    campaign->groups.push_back(std::move(keys));
  }
}

json groups_json(const Campaign& campaign, const std::vector<CampaignRun>& runs,
                 const CampaignResults& results) {
  json groups = json::array();
  for (const std::vector<std::string>& keys : campaign.groups) {
    std::map<std::vector<std::string>, Count> counts;
    for (const auto& [number, result] : results) {
      const CampaignRun& run = run_of(runs, number);
      std::vector<std::string> values;
      values.reserve(keys.size());
      for (const std::string& key : keys) values.push_back(value_of(campaign, run, key));
      Count& count = counts.try_emplace(values, Count{run.cell}).first->second;
      count.cell = std::min(count.cell, run.cell);
      count.runs += 1;
      count.successes += result.success ? 1 : 0;
      count.falls += result.fell ? 1 : 0;
      count.refusals += result.refused ? 1 : 0;
    }
    std::vector<std::pair<std::vector<std::string>, Count>> ordered(counts.begin(), counts.end());
    std::stable_sort(ordered.begin(), ordered.end(),
                     [](const auto& a, const auto& b) { return a.second.cell < b.second.cell; });
    json rows = json::array();
    for (const auto& [values, count] : ordered) {
      json row = count_json(count);
      row["values"] = values;
      for (std::size_t i = 0; i < keys.size(); ++i) {
        row["labels"].push_back(value_label(campaign, keys[i], values[i]));
      }
      rows.push_back(row);
    }
    groups.push_back({{"by", keys}, {"rows", rows}});
  }
  return groups;
}

json targets_json(const Campaign& campaign, const std::vector<CampaignRun>& runs,
                  const CampaignResults& results, json* without_runs) {
  json targets = json::array();
  *without_runs = json::array();
  for (const CampaignTarget& target : campaign.targets) {
    Count count;
    for (const auto& [number, result] : results) {
      const CampaignRun& run = run_of(runs, number);
      const bool meant = std::all_of(
          target.where.begin(), target.where.end(),
          [&](const auto& where) { return value_of(campaign, run, where.first) == where.second; });
      if (!meant) continue;
      count.runs += 1;
      count.successes += result.success ? 1 : 0;
      count.falls += result.fell ? 1 : 0;
      count.refusals += result.refused ? 1 : 0;
    }
    json where = json::object();
    for (const auto& [key, value] : target.where) where[key] = value;
    if (count.runs == 0) {
      without_runs->push_back({{"where", where}, {"rate", target.rate}});
      continue;
    }
    json entry = count_json(count);
    entry["where"] = where;
    entry["rate"] = target.rate;
    entry["pass"] = entry["success_rate"] >= target.rate;
    targets.push_back(entry);
  }
  return targets;
}

std::string groups_text(const json& groups, std::size_t columns) {
  std::string text;
  for (const json& group : groups) {
    std::vector<std::string> header = group["by"];
    header.insert(header.end(), {"SUCCESS", "RATE", "95 % INTERVAL", "FALLS", "REFUSED"});
    std::vector<std::vector<std::string>> rows;
    for (const json& row : group["rows"]) {
      std::vector<std::string> cells = row["labels"];
      cells.insert(cells.end(), {share_text(row), percent_text(row["success_rate"]),
                                 interval_text(row), row["falls"].dump(), row["refusals"].dump()});
      rows.push_back(std::move(cells));
    }
    text += (text.empty() ? "" : "\n") + table(header, rows, columns);
  }
  return text;
}

std::string targets_text(const json& targets, const json& without_runs) {
  std::string text;
  for (const json& target : targets) {
    text += target["pass"].get<bool>() ? "  ok    " : "  FAIL  ";
    text += where_text(target) + share_text(target) + ", " + percent_text(target["success_rate"]) +
            " (" + interval_text(target) + "), at least " + percent_text(target["rate"]) +
            " expected\n";
  }
  for (const json& target : without_runs) {
    text.append("  --    ").append(where_text(target)).append("not judged: no runs\n");
  }
  return text;
}

std::string percent_text(double share) {
  constexpr double kRounding = 1e-9;
  constexpr int kMostDigits = 8;
  char text[32];
  for (int digits = 1; digits <= kMostDigits; ++digits) {
    std::snprintf(text, sizeof(text), "%.*f", digits, 100.0 * share);
    const double shown = std::atof(text);
    const bool none = shown == 0.0 && share > kRounding;
    const bool all = shown == 100.0 && share < 1.0 - kRounding;
    if (!none && !all) break;
  }
  return std::string(text) + " %";
}

}  // namespace gaitd::cli
