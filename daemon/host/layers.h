// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "gaitd/abi/plugin.h"

namespace gaitd::daemon {

/// The name of a layer as in the configuration and in the plugin directory ("icp_planner",
/// "backend"); "unknown" for any other number.
std::string_view layer_name(int layer);

/// The layer (GAITD_LAYER_*) of a name.
std::optional<int> layer_from_name(std::string_view name);

}  // namespace gaitd::daemon
