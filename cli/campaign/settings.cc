// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/settings.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <utility>

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;
using daemon::MapReader;
using daemon::Node;
using daemon::NodeKind;
using daemon::NodePtr;

CampaignSetting read_bundles(MapReader map, const std::string& key, Campaign* campaign) {
  CampaignSetting setting{key, {}};
  for (const Node::Entry& value : map.entries()) {
    std::vector<std::string>& assignments = campaign->bundles[key][value.key];
    for (const Node::Entry& entry : map.map(value.key).entries()) {
      assignments.push_back(entry.key + "=" + setting_text(*entry.value));
    }
    setting.values.push_back(value.key);
  }
  return setting;
}

// Whether it is the same text without quotes: no number, list or anything else.
bool needs_no_quotes(const std::string& text) {
  daemon::Issues unreadable;
  const NodePtr plain = daemon::parse_yaml(text, "", &unreadable);
  return plain != nullptr && plain->kind == NodeKind::kScalar && !plain->quoted &&
         plain->text == text && daemon::to_json(*plain).is_string();
}

}  // namespace

std::string setting_text(const Node& node) {
  const bool plain = node.kind == NodeKind::kScalar && (!node.quoted || needs_no_quotes(node.text));
  return plain ? node.text : daemon::to_json(node).dump();
}

std::string normal_text(const std::string& value) {
  daemon::Issues unreadable;  // gaitd will say so
  const NodePtr node = daemon::parse_yaml(value, "", &unreadable);
  return node == nullptr ? value : setting_text(*node);
}

std::string file_of(const std::string& value) {
  std::error_code ignored;
  const bool named =
      value.find_first_of("./") != std::string::npos && fs::is_regular_file(value, ignored);
  return named ? fs::absolute(value).lexically_normal().string() : "";
}

std::string setting_number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.6g", value);
  return text;
}

void read_settings(MapReader map, Campaign* campaign) {
  for (const Node::Entry& entry : map.entries()) {
    CampaignSetting setting{entry.key, {}};
    if (entry.value->kind == NodeKind::kList) {
      for (const NodePtr& item : entry.value->items) {
        std::string value = setting_text(*item);
        if (std::ranges::find(setting.values, value) != setting.values.end()) {
          map.fail(entry.key, "each value once", daemon::describe(*item),
                   "the same runs twice make no better statistics");
        }
        setting.values.push_back(std::move(value));
      }
    } else if (entry.value->kind == NodeKind::kMap) {
      setting = read_bundles(map.map(entry.key), entry.key, campaign);
    }
    if (setting.values.empty()) {
      map.fail(entry.key, "a list of values, or names with the keys that each sets",
               daemon::describe(*entry.value), "write [a, b]; one value is a list too");
      continue;
    }
    campaign->settings.push_back(std::move(setting));
  }
}

namespace {

// Whether to set one of them sets the other: the same key, or a part of it.
bool overlap(std::string_view a, std::string_view b) {
  if (a.size() > b.size()) std::swap(a, b);
  return b.starts_with(a) && (a.size() == b.size() || b[a.size()] == '.');
}

// The setting whose named values, more than one of them, set the key or a part of it.
std::string bundle_with(const Campaign& campaign, const std::string& key) {
  for (const CampaignSetting& setting : campaign.settings) {
    const auto bundle = campaign.bundles.find(setting.key);
    if (bundle == campaign.bundles.end() || setting.values.size() < 2) continue;
    for (const std::string& value : setting.values) {
      for (const std::string& its : bundle->second.at(value)) {
        if (overlap(key, std::string_view(its).substr(0, its.find('=')))) return setting.key;
      }
    }
  }
  return "";
}

// The one of `values` that is meant; `value` if none is.
std::string own_spelling(const std::vector<std::string>& values, const std::string& value) {
  if (std::ranges::find(values, value) != values.end()) return value;
  const std::string text = normal_text(value), file = file_of(text);
  const auto own = std::ranges::find_if(values, [&](const std::string& known) {
    return known == text || (!file.empty() && file_of(known) == file);
  });
  return own == values.end() ? value : *own;
}

}  // namespace

bool narrow(Campaign* campaign, std::string* assignment, std::string* error) {
  const std::size_t equals = assignment->find('=');
  if (equals == std::string::npos) return false;
  const std::string key = assignment->substr(0, equals);
  // What is drawn is not asked for again: --set comes later, and wins.
  std::erase_if(campaign->draws, [&](const CampaignDraw& draw) { return draw.key == key; });
  const bool searched = campaign->search && overlap(campaign->settings.back().key, key);
  const auto setting =
      std::find_if(campaign->settings.begin(), campaign->settings.end(),
                   [&](const CampaignSetting& candidate) { return candidate.key == key; });
  const std::string bundled = bundle_with(*campaign, key);
  const std::string same = key == "seed" ? "each run has a seed of the campaign's 'seeds'"
                           : searched    ? "the campaign searches along it"
                           : !bundled.empty()
                               ? "the values of '" + bundled + "' set it; choose one of them first"
                               : "";
  if (!same.empty()) {
    *error = "--set " + *assignment + ": " + same + ", or all would be the same run";
    return false;
  }
  if (setting == campaign->settings.end()) return false;
  const std::string value = own_spelling(setting->values, assignment->substr(equals + 1));
  const auto bundle = campaign->bundles.find(key);
  if (bundle != campaign->bundles.end() && !bundle->second.contains(value)) {
    *error = "--set " + *assignment + ": expected one of the campaign's values of '" + key + "':";
    for (const std::string& known : setting->values) *error += " " + known;
    return false;
  }
  if (campaign->plot && campaign->plot->panels == key) {
    std::vector<std::string>& names = campaign->plot->panel_names;
    const auto place = static_cast<std::size_t>(std::ranges::find(setting->values, value) -
                                                setting->values.begin());
    names = {place < names.size() ? names[place] : value};
  }
  setting->values = {value};
  *assignment = key + "=" + value;
  return true;
}

}  // namespace gaitd::cli
