// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/merge.h"

#include <map>
#include <system_error>

#include "cli/campaign/runner.h"
#include "cli/scenario_run.h"
#include "cli/whole_file.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

using Sources = std::map<int, fs::path>;  // by run: the folder that its result is from

bool add_results(const ResultFormat& format, const fs::path& folder, CampaignResults* results,
                 Sources* sources, std::string* error) {
  const auto read = read_results(folder / "results.csv", format, error);
  if (!read) return false;
  for (const auto& [number, result] : *read) {
    const auto [there, fresh] = results->emplace(number, result);
    if (!fresh && !result.problem.empty()) continue;
    // What could not be judged was played again elsewhere.
    if (!fresh && there->second.problem.empty() &&
        format.row(there->second) != format.row(result)) {
      *error = "run " + std::to_string(number) + " came out otherwise in " + folder.string() +
               " than in " + (*sources)[number].string() +
               ": they are of different versions of gaitd, or of processors that compute otherwise";
      return false;
    }
    there->second = result;
    if (fresh || !left_files(campaign_log((*sources)[number], number))) {
      (*sources)[number] = folder;
    }
  }
  return true;
}

// The same bytes in both places; without a second copy of them where that can be.
bool share_file(const fs::path& from, const fs::path& to, std::string* error) {
  std::error_code code;
  fs::remove(to, code);
  fs::create_hard_link(from, to, code);
  if (code) fs::copy_file(from, to, fs::copy_options::overwrite_existing, code);
  if (code) *error = to.string() + ": cannot write: " + code.message();
  return !code;
}

bool add_calibrations(const fs::path& folder, const fs::path& target, std::string* error) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder / "calibrations", ignored)) {
    if (entry.path().extension() != ".yaml") continue;
    const fs::path to = target / "calibrations" / entry.path().filename();
    if (fs::exists(to, ignored)) {
      if (read_file(to) == read_file(entry.path())) continue;
      *error = entry.path().string() + " and " + to.string() + " differ: one robot, measured twice";
      return false;
    }
    fs::create_directories(to.parent_path(), ignored);
    if (!share_file(entry.path(), to, error)) return false;
  }
  return true;
}

bool add_logs(const CampaignPlan& plan, const CampaignResults& results, const Sources& sources,
              const fs::path& target, std::string* error) {
  int kept = 0;
  std::error_code ignored;
  for (const CampaignResult* result : worst_first(results)) {
    const fs::path to = campaign_log(target, result->number);
    const fs::path from = campaign_log(sources.at(result->number), result->number);
    const bool keep = left_files(from) && kept++ < plan.campaign.keep_logs;
    if (keep && from == to) continue;
    remove_run_files(to);
    if (!keep) continue;
    for (const char* extension : kRunFiles) {
      const fs::path its = fs::path(from).replace_extension(extension);
      if (!fs::exists(its, ignored)) continue;
      if (!share_file(its, fs::path(to).replace_extension(extension), error)) return false;
    }
  }
  return true;
}

}  // namespace

bool merge_folders(const CampaignPlan& plan, const std::vector<fs::path>& folders,
                   const fs::path& target, CampaignResults* results, std::string* error) {
  const ResultFormat format(plan.campaign, plan.runs);
  Sources sources;
  if (!add_results(format, target, results, &sources, error)) return false;
  for (const fs::path& folder : folders) {
    const auto theirs = plan_of_folder(folder, error);
    if (!theirs) return false;
    if (theirs->text != plan.text) {
      *error = folder.string() + ": holds another campaign than " + folders.front().string();
      return false;
    }
    if (theirs->origin.build != plan.origin.build) {
      *error = folder.string() + ": expected results of " + plan.origin.build +
               ", as elsewhere, got those of " + theirs->origin.build +
               ", which may walk otherwise; play all shards with one of them";
      return false;
    }
    if (!add_results(format, folder, results, &sources, error) ||
        !add_calibrations(folder, target, error)) {
      return false;
    }
  }
  if (!write_drawn(plan.campaign, plan.runs, target, error) ||
      !write_results(target / "results.csv", format, *results, error)) {
    return false;
  }
  return add_logs(plan, *results, sources, target, error);
}

}  // namespace gaitd::cli
