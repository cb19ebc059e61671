// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign_runner.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <system_error>
#include <thread>

#include "cli/child.h"
#include "cli/gauntlet/gauntlet.h"
#include "cli/stop_signals.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

class Pool {
 public:
  Pool(const Campaign& campaign, const std::vector<CampaignRun>& runs, const RunnerOptions& options,
       ResultFile* results)
      : campaign_(campaign), runs_(runs), options_(options), results_(results) {
    // What a killed campaign left; its last children may still be writing there.
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(logs(), ignored)) {
      if (entry.path().filename().string().starts_with(kRunning)) {
        fs::remove_all(entry.path(), ignored);
      }
    }
    running_ = logs() / (kRunning + std::to_string(getpid()));
    fs::create_directories(running_, ignored);
  }

  // Children that are still there, when anything goes wrong.
  ~Pool() {
    for (const auto& [pid, number] : children_) kill(pid, SIGTERM);
    for (const auto& [pid, number] : children_) waitpid(pid, nullptr, 0);
    std::error_code ignored;
    fs::remove_all(running_, ignored);
  }

  bool idle() const { return children_.empty(); }
  bool full() const { return static_cast<int>(children_.size()) >= options_.jobs; }

  bool start(const CampaignRun& run, std::string* error) {
    std::vector<std::string> arguments{options_.gaitctl.string(),
                                       "--json",
                                       "run",
                                       scenario_of(campaign_, run, options_.folder),
                                       "--log",
                                       running(run.number, ".mcap").string()};
    if (options_.trust) arguments.emplace_back("--trust");
    std::vector<std::string> settings = assignments(campaign_, run);
    settings.insert(settings.end(), options_.settings.begin(), options_.settings.end());
    for (const std::string& setting : settings) {
      arguments.insert(arguments.end(), {"--set", setting});
    }
    const pid_t pid = start_child(arguments, running(run.number, ".json").string(), "/dev/null");
    if (pid < 0) {
      *error = "cannot start " + options_.gaitctl.string() + ": " + std::strerror(errno);
      return false;
    }
    children_[pid] = run.number;
    return true;
  }

  // Takes up one child that has ended. False with an empty error if none has.
  bool take(std::string* error) {
    for (const auto& [pid, number] : children_) {
      int status = 0;
      if (waitpid(pid, &status, WNOHANG) != pid) continue;
      const int run = number;
      children_.erase(pid);
      std::ifstream in(running(run, ".json"));
      const std::string text(std::istreambuf_iterator<char>(in), {});
      CampaignResult result = read_result(campaign_, run, text);
      if (WIFSIGNALED(status)) {
        result.success = false;
        result.problem = "gaitctl run was killed by signal " + std::to_string(WTERMSIG(status));
      }
      std::error_code ignored;
      fs::remove(running(run, ".json"), ignored);
      for (const char* extension : {".mcap", ".txt"}) {
        fs::rename(running(run, extension), log(run, extension), ignored);
      }
      if (!results_->append(result, error)) return false;
      keep_worst();
      return true;
    }
    return false;
  }

  // Deletes all logs but those of the worst runs.
  void keep_worst() {
    std::vector<std::pair<double, int>> logs;
    std::error_code ignored;
    for (const auto& [number, result] : results_->results()) {
      if (deleted_.contains(number)) continue;
      if (fs::exists(campaign_log(options_.folder, number), ignored)) {
        logs.emplace_back(-badness(result), number);
      } else {
        deleted_[number] = true;
      }
    }
    std::sort(logs.begin(), logs.end());
    for (std::size_t i = static_cast<std::size_t>(campaign_.keep_logs); i < logs.size(); ++i) {
      forget(logs[i].second);
      deleted_[logs[i].second] = true;
    }
  }

 private:
  static constexpr const char* kRunning = "running-";

  fs::path logs() const { return campaign_log(options_.folder, 0).parent_path(); }
  fs::path log(int number, const char* extension) const {
    return campaign_log(options_.folder, number).replace_extension(extension);
  }
  // While it is being written.
  fs::path running(int number, const char* extension) const {
    return running_ / log(number, extension).filename();
  }
  void forget(int number) const {
    std::error_code ignored;
    for (const char* extension : {".mcap", ".txt"}) fs::remove(log(number, extension), ignored);
  }

  const Campaign& campaign_;
  const std::vector<CampaignRun>& runs_;
  const RunnerOptions& options_;
  ResultFile* results_;
  fs::path running_;
  std::map<pid_t, int> children_;  // numbers of the runs
  std::map<int, bool> deleted_;
};

}  // namespace

std::string scenario_of(const Campaign& campaign, const CampaignRun& run, const fs::path& folder) {
  if (!campaign.drawn.contains(run.scenario)) return run.scenario;
  return (folder / "scenarios" / (run.scenario + "-" + std::to_string(run.seed) + ".yaml"))
      .string();
}

bool write_drawn(const Campaign& campaign, const fs::path& folder, std::string* error) {
  std::error_code ignored;
  if (!campaign.drawn.empty()) fs::create_directories(folder / "scenarios", ignored);
  for (const std::string& kind : campaign.drawn) {
    for (const std::uint64_t seed : campaign.seeds) {
      CampaignRun run;
      run.scenario = kind;
      run.seed = seed;
      const std::string path = scenario_of(campaign, run, folder);
      const std::string text = gauntlet_scenario(kind, seed);
      std::ifstream in(path, std::ios::binary);
      const std::string there(std::istreambuf_iterator<char>(in), {});
      if (there == text) continue;
      if (!text.starts_with(there)) {
        *error = path + ": another gaitd has drawn it otherwise; give another folder with -o";
        return false;
      }
      std::ofstream out(path, std::ios::binary | std::ios::trunc);
      out << text << std::flush;
      if (out) continue;
      *error = path + ": cannot write: " + std::strerror(errno);
      return false;
    }
  }
  return true;
}

RunnerEnd play_runs(const Campaign& campaign, const std::vector<CampaignRun>& runs,
                    const RunnerOptions& options, RunOrder* order, ResultFile* results,
                    const std::function<void(int)>& progress, std::string* error) {
  using Clock = std::chrono::steady_clock;
  constexpr auto kRefresh = std::chrono::milliseconds(500);
  const StopSignals signals;
  Pool pool(campaign, runs, options, results);
  pool.keep_worst();
  int finished = 0;
  Clock::time_point shown{};
  for (;;) {
    if (StopSignals::requested()) return RunnerEnd::kInterrupted;
    while (!pool.full()) {
      const std::optional<int> next = order->next();
      if (!next) break;
      const CampaignRun& run = runs[static_cast<std::size_t>(*next) - 1];
      if (!pool.start(run, error)) return RunnerEnd::kFailed;
    }
    if (pool.idle()) return RunnerEnd::kDone;
    error->clear();
    // A terminal interrupts the children as well: what they say then is no result.
    while (!StopSignals::requested() && pool.take(error)) {
      ++finished;
      progress(finished);
    }
    if (!error->empty()) return RunnerEnd::kFailed;
    if (Clock::now() - shown >= kRefresh) {
      shown = Clock::now();
      progress(finished);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

}  // namespace gaitd::cli
