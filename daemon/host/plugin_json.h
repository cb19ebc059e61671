// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "daemon/host/plugin_directory.h"

namespace gaitd::daemon {

/// {name, type: real|integer|boolean, unit, min, max, default, description}.
/// "tuning", "porting" or "expert".
const char* rank_name(int rank);
nlohmann::json parameter_json(const GaitdParameter& parameter);

/// The answer to plugin.list: {"plugins": [{layer, variant, path, active, version, build,
/// worst_case_us, parameters: [{name, type, unit, min, max, default, description}]} or {layer,
/// variant, path, refused: text}]}. `active` maps a layer's name to the library in use.
nlohmann::json plugin_list_json(const std::vector<PluginEntry>& entries,
                                const std::map<std::string, std::filesystem::path>& active);

}  // namespace gaitd::daemon
