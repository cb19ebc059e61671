// SPDX-License-Identifier: Apache-2.0
#include "daemon/host/plugin_json.h"

#include "daemon/host/layers.h"

namespace gaitd::daemon {
namespace {

using nlohmann::json;

json entry_json(const PluginEntry& entry,
                const std::map<std::string, std::filesystem::path>& active) {
  const std::string layer(layer_name(entry.layer));
  json out = {{"layer", layer}, {"variant", entry.variant}, {"path", entry.path.string()}};
  if (!entry.descriptor) {
    out["refused"] = entry.refusal.text();
    return out;
  }
  const GaitdPluginDescriptor& d = *entry.descriptor;
  const auto in_use = active.find(layer);
  out["active"] = in_use != active.end() && in_use->second == entry.path;
  out["version"] = d.version;
  out["build"] = d.build;
  out["worst_case_us"] = d.worst_case_us;
  out["parameters"] = json::array();
  for (std::uint32_t i = 0; i < d.parameter_count; ++i) {
    out["parameters"].push_back(parameter_json(d.parameters[i]));
  }
  return out;
}

}  // namespace

const char* rank_name(int rank) {
  return rank == GAITD_RANK_PORTING ? "porting" : rank == GAITD_RANK_EXPERT ? "expert" : "tuning";
}

json parameter_json(const GaitdParameter& p) {
  const char* type = p.type == GAITD_PARAMETER_REAL      ? "real"
                     : p.type == GAITD_PARAMETER_INTEGER ? "integer"
                                                         : "boolean";
  return {{"name", p.name},
          {"type", type},
          {"rank", rank_name(p.rank)},
          {"unit", p.unit},
          {"min", p.minimum},
          {"max", p.maximum},
          {"default", p.default_value},
          {"description", p.description}};
}

json plugin_list_json(const std::vector<PluginEntry>& entries,
                      const std::map<std::string, std::filesystem::path>& active) {
  json plugins = json::array();
  for (const PluginEntry& entry : entries) plugins.push_back(entry_json(entry, active));
  return {{"plugins", std::move(plugins)}};
}

}  // namespace gaitd::daemon
