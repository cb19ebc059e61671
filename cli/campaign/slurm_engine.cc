// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/slurm_engine.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli/campaign/merge.h"
#include "cli/campaign/outcome.h"
#include "cli/campaign/progress.h"
#include "cli/campaign/replay_text.h"
#include "cli/campaign/search.h"
#include "cli/campaign/shard_progress.h"
#include "cli/campaign/slurm.h"
#include "cli/failure.h"
#include "cli/one_line.h"
#include "cli/print.h"
#include "cli/stop_signals.h"
#include "cli/whole_file.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kUsualShards = 100;

struct Job {
  std::string number;  // "": none was submitted yet
  int shards = 0;
};

fs::path job_file(const fs::path& folder) { return folder / "slurm" / "job.json"; }

Job read_job(const fs::path& folder) {
  std::ifstream in(job_file(folder));
  const json document = json::parse(in, nullptr, false);
  if (!document.is_object()) return {};
  return {document.value("job", ""), document.value("shards", 0)};
}

bool write_job(const fs::path& folder, const Job& job, std::string* error) {
  const json document = {{"job", job.number}, {"shards", job.shards}};
  return write_file(job_file(folder), json_text(document), error);
}

fs::path shard_folder(const fs::path& folder, int index) {
  char name[16];
  std::snprintf(name, sizeof(name), "%04d", index);
  return folder / "shards" / name;
}

enum class Unjudged { kAgain, kEnded };

// Those that have runs to play; `unjudged`: whether what could not be judged is one of them.
std::optional<std::vector<int>> open_shards(const CampaignPlan& plan, const fs::path& folder,
                                            int shards, Unjudged unjudged, std::string* error) {
  const ResultFormat format(plan.campaign, plan.runs);
  CampaignResults all;
  for (int index = 1; index <= shards; ++index) {
    auto results = read_results(shard_folder(folder, index) / "results.csv", format, error);
    if (!results) return std::nullopt;
    all.merge(*results);
  }
  if (unjudged == Unjudged::kAgain) {
    std::erase_if(all, [](const auto& entry) { return !entry.second.problem.empty(); });
  }
  RunOrder order(plan.campaign, plan.runs, all);
  std::vector<int> open;
  for (int index = 1; index <= shards; ++index) {
    if (order.remaining(Shard{index, shards}) > 0) open.push_back(index);
  }
  return open;
}

// "1-3,7", as Slurm and people read it.
std::string list_text(const std::vector<int>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    text += (text.empty() ? "" : ",") + std::to_string(numbers[i]);
    if (last > i) text += "-" + std::to_string(numbers[last]);
    i = last + 1;
  }
  return text;
}

std::string script_text(const CampaignPlan& plan, const RunnerOptions& options, int shards) {
  std::string shard_command = shell_word(options.gaitctl.string()) + " campaign " +
                              shell_word(plan.origin.file) + " --shard \"$SLURM_ARRAY_TASK_ID/" +
                              std::to_string(shards) + "\"";
  for (const std::string& setting : plan.origin.settings) {
    shard_command += " --set " + shell_word(setting);
  }
  if (plan.origin.trust) shard_command += " --trust";
  return "#!/bin/sh\n# A shard of the campaign " + one_line(plan.campaign.name) +
         ".\nfolder=" + shell_word((options.folder / "shards").string()) +
         "/$(printf %04d \"$SLURM_ARRAY_TASK_ID\")\nexec " + shard_command +
         " --jobs \"${SLURM_CPUS_PER_TASK:-1}\" -o \"$folder\"\n";
}

std::optional<std::string> submit(const CampaignPlan& plan, const RunnerOptions& options,
                                  int shards, const std::vector<int>& open, Slurm* slurm,
                                  std::string* error) {
  const fs::path script = options.folder / "slurm" / "job.sh";
  if (!write_file(script, script_text(plan, options, shards), error)) return std::nullopt;
  const std::string at_once = options.jobs > 0 ? "%" + std::to_string(options.jobs) : "";
  // A task that Slurm starts anew could meet the one that it took for lost; --resume is asked for.
  return slurm->submit(
      {"--job-name=" + plan.campaign.name, "--array=" + list_text(open) + at_once, "--ntasks=1",
       "--no-requeue", "--output=" + (options.folder / "slurm" / "%A-%a.txt").string(),
       script.string()},
      error);
}

enum class WaitEnd { kOver, kInterrupted };

// Until no task of the job waits or runs, with a bar of what they have done.
WaitEnd wait_for(const CampaignPlan& plan, const fs::path& folder, const std::string& part,
                 const Job& job, Slurm* slurm) {
  using Clock = std::chrono::steady_clock;
  const StopSignals signals;
  const ResultFormat format(plan.campaign, plan.runs);
  std::vector<ShardProgress> shards;
  for (int index = 1; index <= job.shards; ++index) {
    shards.emplace_back(format, shard_folder(folder, index) / "results.csv");
  }
  const std::size_t total = RunOrder(plan.campaign, plan.runs, {}).remaining();
  const auto pause = std::chrono::milliseconds(std::max(1000, 10 * job.shards));
  ProgressBar bar(part + "job " + job.number + " ");
  std::string told;
  int before = -1;
  Clock::time_point next{};
  while (!StopSignals::requested()) {
    if (Clock::now() < next) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      continue;
    }
    std::string error;
    // Asked first: what a task wrote before it ended is then counted.
    const auto queue = slurm->queue(job.number, &error);
    std::size_t done = 0;
    int failed = 0;
    for (ShardProgress& shard : shards) {
      shard.look();
      done += static_cast<std::size_t>(shard.done());
      failed += shard.failed();
    }
    if (before < 0) before = static_cast<int>(done);
    if (!queue && error != told) std::cerr << "gaitctl: campaign: " << error << "; asked again\n";
    told = error;
    if (queue) {
      bar.show({done, std::max(total, done), failed, static_cast<int>(done) - before},
               std::to_string(queue->waiting) + " shards wait, " + std::to_string(queue->running) +
                   " run");
      if (queue->over()) {
        bar.end();
        return WaitEnd::kOver;
      }
    }
    next = Clock::now() + pause;
  }
  bar.end();
  return WaitEnd::kInterrupted;
}

int merge_all(const Context& context, const CampaignPlan& plan, const RunnerOptions& options,
              int shards) {
  std::vector<fs::path> folders;
  for (int index = 1; index <= shards; ++index) {
    folders.push_back(shard_folder(options.folder, index));
  }
  CampaignResults results;
  std::string error;
  if (!merge_folders(plan, folders, options.folder, &results, &error)) {
    return fail(context, kFailed, "campaign", error);
  }
  return conclude(context, plan, results, options) ? kDone : kFailed;
}

}  // namespace

int play_on_slurm(const Context& context, const CampaignPlan& plan, const RunnerOptions& options,
                  int shards) {
  const fs::path& folder = options.folder;
  const auto failed = [&](const std::string& why) {
    return fail(context, kFailed, "campaign", why);
  };
  if (const std::string missing = Slurm::missing(); !missing.empty()) {
    return failed("--engine slurm needs " + missing +
                  ", which is not on PATH: start on a node of the cluster, or install its commands "
                  "(Debian: apt-get install slurm-client)");
  }
  std::string error;
  Job job = read_job(folder);
  std::error_code ignored;
  if (job.shards == 0) {
    if (fs::exists(folder / "results.csv", ignored)) {
      return failed(folder.string() + ": was played without Slurm; give another folder with -o");
    }
    fs::create_directories(folder / "slurm", ignored);
    fs::create_directories(folder / "shards", ignored);
    const int most = static_cast<int>(RunOrder(plan.campaign, plan.runs, {}).parts());
    job.shards = std::min(shards > 0 ? shards : kUsualShards, most);
  } else if (shards > 0 && shards != job.shards) {
    return failed(folder.string() + ": is cut into " + std::to_string(job.shards) +
                  " shards; give that number, or another folder with -o");
  }
  Slurm slurm(folder / "slurm");
  SlurmQueue queue;
  if (!job.number.empty()) {
    const auto there = slurm.queue(job.number, &error);
    if (!there) return failed(error);
    queue = *there;
  }
  if (queue.over()) {
    const auto open = open_shards(plan, folder, job.shards, Unjudged::kAgain, &error);
    if (!open) return failed(error);
    if (open->empty()) return merge_all(context, plan, options, job.shards);
    const auto number = submit(plan, options, job.shards, *open, &slurm, &error);
    if (!number) return failed(error);
    job.number = *number;
    if (!write_job(folder, job, &error)) return failed(error);
    std::cerr << "job " << job.number << ": " << open->size() << " of " << job.shards
              << " shards\n";
  }
  if (wait_for(plan, folder, options.part, job, &slurm) == WaitEnd::kInterrupted) {
    std::cerr << "interrupted; job " << job.number << " goes on: --resume waits for it, scancel "
              << job.number << " ends it\n";
    return kInterrupted;
  }
  const auto open = open_shards(plan, folder, job.shards, Unjudged::kEnded, &error);
  if (!open) return failed(error);
  if (open->empty()) return merge_all(context, plan, options, job.shards);
  return failed(std::to_string(open->size()) + " of " + std::to_string(job.shards) +
                " shards did not finish (" + list_text(*open) +
                "): --resume plays what is missing; what they said is in " +
                (folder / "slurm").string());
}

bool holds_slurm_job(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(job_file(folder), ignored);
}

}  // namespace gaitd::cli
