// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/campaign/campaign.h"

namespace gaitd::cli {

/// A value of a setting as people read it: of the file of a plugin its name, with as much of its
/// folder as tells it from the other values.
std::string value_label(const Campaign& campaign, const std::string& key, const std::string& value);

}  // namespace gaitd::cli
