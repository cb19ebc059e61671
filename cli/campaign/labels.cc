// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/labels.h"

#include <algorithm>
#include <filesystem>

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

bool is_plugin_file(const std::string& value) { return fs::path(value).extension() == ".so"; }

// The last `parts` of the path, without its ending.
std::string tail(const std::string& file, int parts) {
  fs::path rest = fs::path(file).replace_extension("");
  fs::path name = rest.filename();
  while (--parts > 0 && rest.has_parent_path() && rest.parent_path() != rest) {
    rest = rest.parent_path();
    name = rest.filename() / name;
  }
  return name.string();
}

}  // namespace

std::string value_label(const Campaign& campaign, const std::string& key,
                        const std::string& value) {
  if (!is_plugin_file(value)) return value;
  const auto setting =
      std::find_if(campaign.settings.begin(), campaign.settings.end(),
                   [&](const CampaignSetting& candidate) { return candidate.key == key; });
  if (setting == campaign.settings.end()) return tail(value, 1);
  const int most = static_cast<int>(std::count(value.begin(), value.end(), '/')) + 1;
  for (int parts = 1; parts <= most; ++parts) {
    std::string name = tail(value, parts);
    const bool unique =
        std::none_of(setting->values.begin(), setting->values.end(), [&](const std::string& other) {
          return other != value &&
                 (other == name || (is_plugin_file(other) && tail(other, parts) == name));
        });
    if (unique) return name;
  }
  return value;
}

}  // namespace gaitd::cli
