// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/campaign/campaign.h"
#include "daemon/config/yaml_reader.h"

namespace gaitd::cli {

/// As YAML takes it behind KEY=; a word is the same with and without quotes.
std::string setting_text(const daemon::Node& node);

/// A value that a campaign makes itself, for KEY=.
std::string setting_number(double value);

/// Reads `set:`. The values of a key are a list, or names, each with a map of what it stands for.
void read_settings(daemon::MapReader map, Campaign* campaign);

/// KEY=VALUE of a key that the campaign sets leaves this one of its values; of one that it draws,
/// the draw. False if the assignment is about neither, or with what is wrong in `error`.
bool narrow(Campaign* campaign, const std::string& assignment, std::string* error);

}  // namespace gaitd::cli
