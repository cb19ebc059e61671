// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/runner.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "cli/campaign/calibration.h"
#include "cli/child_pool.h"
#include "cli/gauntlet/gauntlet.h"
#include "cli/scenario_run.h"
#include "cli/stop_signals.h"
#include "cli/whole_file.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

// The logs of the runs: while they are written where there is room, then those of the worst in the
// folder of the campaign.
class Logs {
 public:
  Logs(const fs::path& folder, const fs::path& scratch, int keep) : folder_(folder), keep_(keep) {
    // What a killed campaign left; its last children may still be writing there.
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(logs(), ignored)) {
      if (entry.path().filename().string().starts_with(kRunning)) {
        fs::remove_all(entry.path(), ignored);
      }
    }
    running_ = (scratch.empty() ? logs() : scratch) / (kRunning + std::to_string(getpid()));
    fs::create_directories(running_, ignored);
  }

  ~Logs() {
    std::error_code ignored;
    fs::remove_all(running_, ignored);
  }

  // While they are being written.
  fs::path running(int number, const char* extension) const {
    return running_ / log(number, extension).filename();
  }

  // What names a file while it is written names where it is going to be.
  std::string settled(std::string text) const {
    const std::string from = running_.string(), to = logs().string();
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
      text.replace(at, from.size(), to);
    }
    return text;
  }

  // Those of the worst runs stay, or come from where they were written: if this is one of them,
  // that of the least bad goes. False with a reason in `error`.
  bool take(const CampaignResult& result, std::string* error) {
    const int number = result.number;
    const bool fresh = left_files(running(number, ".mcap"));
    if (!fresh && !left_files(campaign_log(folder_, number))) return true;
    kept_.emplace(-badness(result), number);
    int gone = 0;
    if (static_cast<int>(kept_.size()) > keep_) {
      gone = kept_.rbegin()->second;
      forget(gone);
      kept_.erase(std::prev(kept_.end()));
    }
    return !fresh || gone == number || keep(number, error);
  }

 private:
  static constexpr const char* kRunning = "running-";

  fs::path logs() const { return campaign_log(folder_, 0).parent_path(); }
  fs::path log(int number, const char* extension) const {
    return campaign_log(folder_, number).replace_extension(extension);
  }
  bool keep(int number, std::string* error) const {
    for (const char* extension : kRunFiles) {
      const fs::path from = running(number, extension), to = log(number, extension);
      std::error_code code;
      if (!fs::exists(from, code)) continue;
      fs::rename(from, to, code);
      if (!code) continue;
      fs::copy_file(from, to, fs::copy_options::overwrite_existing, code);  // to another disk
      if (code) {
        *error = to.string() + ": cannot write: " + code.message() +
                 "; the same command plays run " + std::to_string(number) + " again";
        fs::remove(to, code);
        return false;
      }
      fs::remove(from, code);
    }
    return true;
  }
  void forget(int number) const {
    remove_run_files(campaign_log(folder_, number));
    remove_run_files(running(number, ".mcap"));
  }

  const fs::path folder_;
  const int keep_;
  fs::path running_;
  std::set<std::pair<double, int>> kept_;  // the worst first: by badness, then by number
};

std::vector<std::string> arguments_of(const Campaign& campaign, const CampaignRun& run,
                                      const RunnerOptions& options, const fs::path& log) {
  std::vector<std::string> arguments{options.gaitctl.string(),
                                     "--json",
                                     "run",
                                     scenario_of(campaign, run, options.folder),
                                     "--log",
                                     log.string()};
  if (options.trust) arguments.emplace_back("--trust");
  for (const std::string& setting : played_settings(campaign, run, options)) {
    arguments.insert(arguments.end(), {"--set", setting});
  }
  return arguments;
}

// Why the robot of this run could not be measured; null if nothing is wrong.
const std::string* failure_of(const Campaign& campaign, const CampaignRun& run,
                              const RunnerOptions& options, const CalibrationFailures& failures) {
  if (failures.empty()) return nullptr;
  const auto calibration =
      calibration_of(campaign, run, settings_of(campaign, run, options), options.folder);
  const auto failure = calibration ? failures.find(calibration->file.string()) : failures.end();
  return failure == failures.end() ? nullptr : &failure->second;
}

CampaignResult result_of(const Campaign& campaign, int number, int status, const fs::path& output) {
  CampaignResult result = read_result(campaign, number, read_file(output));
  if (WIFSIGNALED(status)) {
    result.success = false;
    result.problem = "gaitctl run was killed by signal " + std::to_string(WTERMSIG(status));
  }
  std::error_code ignored;
  fs::remove(output, ignored);
  return result;
}

}  // namespace

std::string scenario_of(const Campaign& campaign, const CampaignRun& run, const fs::path& folder) {
  if (!campaign.drawn.contains(run.scenario)) return scenario_from(campaign.file, run.scenario);
  return (folder / "scenarios" / (run.scenario + "-" + std::to_string(run.seed) + ".yaml"))
      .string();
}

bool write_drawn(const Campaign& campaign, const std::vector<CampaignRun>& runs,
                 const fs::path& folder, std::string* error) {
  std::error_code ignored;
  if (!campaign.drawn.empty()) fs::create_directories(folder / "scenarios", ignored);
  std::set<std::string> seen;
  for (const CampaignRun& run : runs) {
    if (!campaign.drawn.contains(run.scenario)) continue;
    const std::string path = scenario_of(campaign, run, folder);
    if (!seen.insert(path).second) continue;
    const std::string text = gauntlet_scenario(run.scenario, run.seed);
    const std::string there = read_file(path);
    if (there == text) continue;
    if (!text.starts_with(there)) {
      *error = path + ": another gaitd has drawn it otherwise; give another folder with -o";
      return false;
    }
    if (!write_file(path, text, error)) return false;
  }
  return true;
}

std::vector<std::string> settings_of(const Campaign& campaign, const CampaignRun& run,
                                     const RunnerOptions& options) {
  std::vector<std::string> settings = assignments(campaign, run);
  settings.insert(settings.end(), options.settings.begin(), options.settings.end());
  return settings;
}

std::vector<std::string> played_settings(const Campaign& campaign, const CampaignRun& run,
                                         const RunnerOptions& options) {
  std::vector<std::string> settings = settings_of(campaign, run, options);
  if (const auto calibration = calibration_of(campaign, run, settings, options.folder)) {
    constexpr std::string_view kKey = "calibration=";
    std::erase_if(settings, [&](const std::string& s) { return s.starts_with(kKey); });
    settings.push_back(std::string(kKey) + calibration->file.string());
  }
  return settings;
}

PoolEnd play_runs(const Campaign& campaign, const std::vector<CampaignRun>& runs,
                  const RunnerOptions& options, const CalibrationFailures& failures,
                  RunOrder* order, ResultFile* results, const std::function<void(int)>& progress,
                  std::string* error) {
  const StopSignals signals;
  Logs logs(options.folder, options.scratch, campaign.keep_logs);
  ChildPool pool(options.jobs);
  for (const auto& [number, result] : results->results()) {
    if (!logs.take(result, error)) return PoolEnd::kFailed;
  }
  int finished = 0;
  const auto append = [&](const CampaignResult& result, std::string* why) {
    // Logs first: whoever is killed in between plays this run again, and finds what it needs.
    results->add(result);
    if (!logs.take(result, why) || !results->write(result, why)) return false;
    ++finished;
    return true;
  };
  const auto start = [&](std::string* why) {
    const std::optional<int> next = order->next();
    if (!next) return false;
    const CampaignRun& run = runs[static_cast<std::size_t>(*next) - 1];
    if (const std::string* failure = failure_of(campaign, run, options, failures)) {
      if (!append(unjudged_result(run.number, *failure), why)) return false;
      progress(finished);
      return true;
    }
    return pool.start(run.number,
                      arguments_of(campaign, run, options, logs.running(run.number, ".mcap")),
                      logs.running(run.number, ".json").string(), "/dev/null", why);
  };
  // What no run can play is no result of the campaign: it would say so as often as it has runs.
  const auto hopeless = [&](const CampaignResult& result) {
    return options.part.empty() && !result.problem.empty() && results->none_judged() &&
           static_cast<int>(results->results().size()) >= std::max(4, 2 * options.jobs);
  };
  const auto finish = [&](const ChildPool::End& end, std::string* why) {
    CampaignResult result =
        result_of(campaign, end.number, end.status, logs.running(end.number, ".json"));
    result.problem = logs.settled(result.problem);
    if (!append(result, why)) return false;
    if (!hopeless(result)) return true;
    *why = "none of the first " + std::to_string(results->results().size()) +
           " runs could be judged, so no more are played; run " + std::to_string(end.number) +
           ": " + result.problem;
    return false;
  };
  return work_off(&pool, {start, finish, [&] { progress(finished); }}, error);
}

}  // namespace gaitd::cli
