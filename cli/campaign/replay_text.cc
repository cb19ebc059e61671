// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/replay_text.h"

#include <system_error>

#include "cli/campaign/calibration.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

std::string calibrate_text(const Campaign& campaign, const Calibration& calibration) {
  std::string text = "gaitctl";
  for (const std::string& argument : calibrate_arguments(campaign, calibration, calibration.file)) {
    text += " " + shell_word(argument);
  }
  return text;
}

}  // namespace

std::string shell_word(const std::string& word) {
  if (word.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789"
                             "_-./=:,@%+") == std::string::npos) {
    return word;
  }
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string replay_text(const Campaign& campaign, const CampaignRun& run,
                        const RunnerOptions& options, const fs::path& shown) {
  RunnerOptions there = options;
  there.folder = shown;
  const std::vector<std::string> settings = settings_of(campaign, run, options);
  const auto measured = calibration_of(campaign, run, settings, options.folder);
  std::error_code ignored;
  if (measured && !fs::exists(measured->file, ignored)) {
    return calibrate_text(campaign, *calibration_of(campaign, run, settings, shown));
  }
  std::string text = "gaitctl run " + shell_word(scenario_of(campaign, run, shown));
  for (const std::string& setting : played_settings(campaign, run, there)) {
    text += " --set " + shell_word(setting);
  }
  return text + (options.trust ? " --trust" : "");
}

}  // namespace gaitd::cli
