// SPDX-License-Identifier: Apache-2.0
#include "cli/tune/stage.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <system_error>

#include "cli/campaign/local_engine.h"
#include "cli/campaign/slurm_engine.h"
#include "cli/failure.h"
#include "cli/print.h"
#include "cli/whole_file.h"
#include "daemon/config/node.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kSetting = "candidate";

// A file beside the campaign is named from the folder of the tuning.
std::string seen_from(const fs::path& folder, const std::string& file,
                      const std::string& scenario) {
  const std::string there = scenario_from(file, scenario);
  return there == scenario ? scenario : fs::proximate(there, folder).string();
}

json document_of(const Campaign& campaign) {
  daemon::Issues issues;  // it was read before
  return daemon::to_json(*daemon::parse_yaml(campaign.text, campaign.file, &issues));
}

// The file of the stage: that of the tuning with these candidates.
std::string stage_text(const Campaign& campaign, const Stage& stage, const fs::path& folder) {
  json document = document_of(campaign);
  const CampaignTune& tune = *campaign.tune;
  for (const char* key : {"tune", "plot", "groups"}) document.erase(key);
  document["name"] = campaign.name + " " + stage.name;
  document["success_min"] = 0;
  document["seeds"] = stage.held_out ? tune.held_out_seeds : campaign.seeds;
  if (!stage.held_out) document["keep_logs"] = 0;
  if (stage.held_out) {
    for (const std::string& kind : tune.held_out_kinds) document["gauntlet"].push_back(kind);
    for (const std::string& one : tune.held_out_scenarios) document["scenarios"].push_back(one);
  }
  if (document.contains("scenarios")) {
    for (json& scenario : document["scenarios"]) {
      scenario = seen_from(folder, campaign.file, scenario.get<std::string>());
    }
  }
  json& calibrate = document["calibrate"];
  if (calibrate.is_object() && calibrate.contains("motions")) {
    json& motions = calibrate["motions"];
    motions = seen_from(folder, campaign.file, motions.get<std::string>());
  }
  if (calibrate.is_null()) document.erase("calibrate");
  json& candidates = document["set"][kSetting] = json::object();
  for (const Candidate& candidate : stage.candidates) {
    json& values = candidates[candidate.name] = json::object();
    for (std::size_t i = 0; i < candidate.values.size(); ++i) {
      values[tune.parameters[i].key] = std::stod(candidate.values[i]);
    }
  }
  return json_text(document);
}

// What another stage has measured of the same robots.
void take_calibrations(const fs::path& tuning, const fs::path& folder) {
  std::error_code ignored;
  for (const auto& other : fs::directory_iterator(tuning, ignored)) {
    for (const auto& entry : fs::directory_iterator(other.path() / "calibrations", ignored)) {
      if (entry.path().extension() != ".yaml") continue;
      fs::create_directories(folder / "calibrations", ignored);
      fs::copy_file(entry.path(), folder / "calibrations" / entry.path().filename(),
                    fs::copy_options::skip_existing, ignored);
    }
  }
}

}  // namespace

std::vector<const CampaignResult*> StageResults::runs(const std::string& candidate) const {
  const std::vector<CampaignSetting>& settings = plan.campaign.settings;
  const auto place =
      static_cast<std::size_t>(std::find_if(settings.begin(), settings.end(),
                                            [](const auto& one) { return one.key == kSetting; }) -
                               settings.begin());
  std::vector<const CampaignResult*> runs;
  for (const auto& [number, result] : results) {
    const CampaignRun& run = plan.runs[static_cast<std::size_t>(number) - 1];
    if (run.values[place] == candidate) runs.push_back(&result);
  }
  return runs;
}

std::optional<StageResults> play_stage(const Context& context, const CampaignPlan& tuning,
                                       const Stage& stage, const StageOptions& options,
                                       int* exit_code) {
  const auto failed = [&](const std::string& why) {
    *exit_code = fail(context, kFailed, "campaign tune", why);
    return std::nullopt;
  };
  const fs::path file = options.folder / (stage.name + ".yaml"),
                 folder = options.folder / stage.name;
  const std::string text = stage_text(tuning.campaign, stage, options.folder);
  std::string error;
  if (!write_file(file, text, &error)) return failed(error);
  auto plan =
      plan_of_file({file.string(), tuning.origin.settings, tuning.origin.trust, {}}, &error);
  if (!plan) return failed(error);
  CampaignFolder taken;
  if (!taken.take(folder, *plan, &error)) return failed(error);
  take_calibrations(options.folder, folder);
  std::error_code ignored;
  RunnerOptions runner{fs::read_symlink("/proc/self/exe", ignored), folder, plan->settings,
                       options.jobs, tuning.origin.trust};
  runner.part = stage.title + " ";
  *exit_code = options.engine == "slurm" ? play_on_slurm(context, *plan, runner, options.shards)
                                         : play_locally(context, *plan, runner);
  if (*exit_code != kDone) return std::nullopt;
  const ResultFormat format(plan->campaign, plan->runs);
  auto results = read_results(folder / "results.csv", format, &error);
  if (!results) return failed(error);
  for (const auto& [number, result] : *results) {
    if (result.problem.empty()) continue;
    return failed(folder.string() + ": run " + std::to_string(number) +
                  " could not be judged: " + result.problem + "; the same command plays it again");
  }
  return StageResults{std::move(*plan), std::move(*results)};
}

}  // namespace gaitd::cli
