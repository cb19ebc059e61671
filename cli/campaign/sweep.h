// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/campaign/campaign.h"
#include "daemon/config/yaml_reader.h"

namespace gaitd::cli {

/// The setting of a sweep: `icp_planner/heel_to_toe.entry_x=-1`.
inline constexpr const char* kSweptSetting = "parameter";

/// Reads `sweep:` as one more setting of the campaign: each parameter of the daemon and of the
/// installed plugins at either end of its range, one at a time.
void read_sweep(daemon::MapReader map, Campaign* campaign);

}  // namespace gaitd::cli
