// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/campaign/campaign.h"
#include "daemon/config/yaml_reader.h"

namespace gaitd::cli {

/// As YAML takes it behind KEY=; a word is the same with and without quotes.
std::string setting_text(const daemon::Node& node);

/// Likewise of what is behind KEY= already; as it is if it is no YAML.
std::string normal_text(const std::string& value);

/// The whole path of the file that a value names, "" if it names none: a word like `nominal` is no
/// file, whatever lies in this folder.
std::string file_of(const std::string& value);

/// A value that a campaign makes itself, for KEY=.
std::string setting_number(double value);

/// Reads `set:`. The values of a key are a list, or names, each with a map of what it stands for.
void read_settings(daemon::MapReader map, Campaign* campaign);

/// KEY=VALUE of a key that the campaign sets leaves this one of its values, and is spelled as there
/// from then on; of one that it draws, it replaces the draw. False if the assignment is no choice
/// of a value, or with what is wrong in `error`.
bool narrow(Campaign* campaign, std::string* assignment, std::string* error);

}  // namespace gaitd::cli
