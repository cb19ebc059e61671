// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/campaign/campaign.h"
#include "daemon/config/yaml_reader.h"

namespace gaitd::cli {

/// Reads `tune:`; to be called after scenarios, settings and seeds are read.
void read_tune(daemon::MapReader map, Campaign* campaign);

}  // namespace gaitd::cli
