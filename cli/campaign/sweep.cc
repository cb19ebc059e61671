// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/sweep.h"

#include <algorithm>
#include <set>

#include "daemon/config/paths.h"
#include "daemon/log/glob.h"
#include "daemon/parameters/reference.h"

namespace gaitd::cli {
namespace {

using daemon::NodePtr;

std::vector<std::string> texts(daemon::MapReader* map, const char* key) {
  std::vector<std::string> out;
  for (const NodePtr& node : map->list(key, 1, 1000)) out.push_back(node->text);
  return out;
}

bool matches(const std::vector<std::string>& globs, const std::string& key) {
  return globs.empty() || std::any_of(globs.begin(), globs.end(), [&](const std::string& glob) {
           return daemon::glob_match(glob, key);
         });
}

}  // namespace

void read_sweep(daemon::MapReader map, Campaign* campaign) {
  if (!map.valid()) return;
  const std::vector<std::string> globs = texts(&map, "parameters");
  const std::vector<std::string> ends = texts(&map, "ends");
  const std::vector<std::string> defaults = texts(&map, "defaults");
  map.finish();

  daemon::LiveParameters all;
  const daemon::Paths paths = daemon::Paths::detect();
  daemon::add_all_parameters(daemon::PluginDirectory(paths.plugin_folders()).list(), &all);
  CampaignSetting setting{kSweptSetting, {}};
  for (int i = 0; i < all.size(); ++i) {
    const daemon::LiveParameters::Row& row = all.row(i);
    if (!matches(globs, row.key)) continue;
    const std::size_t dot = row.key.find('.');
    const std::string scope = row.key.substr(0, dot);
    const std::string name =
        row.variant.empty() ? row.key : scope + "/" + row.variant + row.key.substr(dot);
    const GaitdParameter& p = row.declared;
    std::set<double> values{p.minimum, p.maximum};
    if (row.effect.kind == daemon::ParameterEffect::kBounded) {
      values.insert({row.effect.minimum, row.effect.maximum});
    }
    for (const double end : values) {
      if (end == p.default_value) continue;
      std::vector<std::string> assignments;
      if (!row.variant.empty()) assignments.push_back(scope + ".variant=" + row.variant);
      const std::string value = "=" + daemon::value_text(p, end);
      if (ends.empty()) assignments.push_back(row.key + value);
      for (const std::string& place : ends) assignments.push_back(place + "." + row.key + value);
      for (const std::string& place : defaults) {
        assignments.push_back(place + "." + row.key + "=" + daemon::value_text(p, p.default_value));
      }
      setting.values.push_back(name + value);
      campaign->bundles[kSweptSetting][name + value] = std::move(assignments);
    }
  }
  if (setting.values.empty()) {
    map.fail("parameters", "globs of keys as `gaitctl param list` shows them", "none that matches",
             "for example [gait.*]");
    return;
  }
  campaign->settings.push_back(std::move(setting));
}

}  // namespace gaitd::cli
