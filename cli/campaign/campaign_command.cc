// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/campaign_command.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>
#include <system_error>
#include <thread>

#include "cli/campaign/local_engine.h"
#include "cli/campaign/merge.h"
#include "cli/campaign/outcome.h"
#include "cli/campaign/page_command.h"
#include "cli/campaign/plan.h"
#include "cli/campaign/runner.h"
#include "cli/campaign/search.h"
#include "cli/campaign/slurm_engine.h"
#include "cli/failure.h"
#include "cli/private_directory.h"
#include "cli/setting_option.h"
#include "cli/tune/tune_command.h"
#include "daemon/config/issues.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

struct CampaignArguments {
  std::string file;
  std::string folder;
  std::vector<std::string> settings;
  std::string engine = "local";
  std::string shard;
  int shards = 0;
  int jobs = 0;
  bool resume = false;
  bool trust = false;
};

struct MergeArguments {
  std::vector<std::string> folders;
  std::string output;
};

// Of a file that is not there: what beside it may be meant.
std::string missing_file(const std::string& file) {
  const fs::path path(file);
  std::vector<std::string> names;
  std::error_code ignored;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().filename().string());
  }
  const std::string near = daemon::closest_name(path.filename().string(), names);
  return file + ": no such file; " +
         (near.empty() ? "give the path of a campaign"
                       : "did you mean '" + path.parent_path().append(near).string() + "'?");
}

RunnerOptions runner_options(const CampaignPlan& plan, const fs::path& folder, int jobs) {
  std::error_code ignored;
  return {fs::read_symlink("/proc/self/exe", ignored), folder, plan.settings, jobs,
          plan.origin.trust};
}

// Why the campaign cannot be cut into these shards; empty if it can.
std::string wrong_shard(const CampaignPlan& plan) {
  if (!plan.campaign.search) return "";
  const std::size_t parts = RunOrder(plan.campaign, plan.runs, {}).parts();
  if (static_cast<std::size_t>(plan.origin.shard.count) <= parts) return "";
  return "--shard " + shard_text(plan.origin.shard) + ": the campaign has " +
         std::to_string(parts) + (parts == 1 ? " search" : " searches") +
         ", one for each combination, and each needs its own results to go on: give at most " +
         "--shard I/" + std::to_string(parts);
}

// Why this campaign does not begin in the folder like this; empty if it does.
std::string wrong_folder(const CampaignArguments& arguments, const fs::path& folder) {
  if (arguments.resume && !holds_campaign(folder)) {
    return folder.string() + ": --resume, but no campaign was started there; leave it out, or " +
           "give the folder with -o";
  }
  if (arguments.engine == "local" && holds_slurm_job(folder)) {
    return folder.string() + ": is played by Slurm; go on with --engine slurm, or give another " +
           "folder with -o";
  }
  return "";
}

int run(const Context& context, const CampaignArguments& arguments) {
  const auto failed = [&](const std::string& why) {
    return fail(context, kFailed, "campaign", why);
  };
  const bool on_slurm = arguments.engine == "slurm";
  if (arguments.file.empty()) return fail(context, kUsage, "campaign", "FILE is required");
  if (on_slurm && !arguments.shard.empty()) {
    return fail(context, kUsage, "campaign", "--shard is for other engines than slurm, which cuts");
  }
  std::error_code ignored;
  if (!fs::exists(arguments.file, ignored)) return failed(missing_file(arguments.file));
  const fs::path file = fs::absolute(arguments.file).lexically_normal();
  const Shard shard = parse_shard(arguments.shard).value_or(Shard{});
  std::string error;
  const auto plan =
      plan_of_file({file.string(), arguments.settings, arguments.trust, shard}, &error);
  if (!plan) return failed(error);
  if (plan->campaign.tune) {
    return failed(file.string() + ": has a section 'tune'; play it with gaitctl campaign tune");
  }
  if (const std::string why = wrong_shard(*plan); !why.empty()) return failed(why);
  const fs::path folder =
      fs::absolute(arguments.folder.empty() ? file.stem().string() + "-results" : arguments.folder)
          .lexically_normal();
  if (const std::string why = wrong_folder(arguments, folder); !why.empty()) return failed(why);
  CampaignFolder taken;
  if (!taken.take(folder, *plan, &error)) return failed(error);
  if (on_slurm) {
    return play_on_slurm(context, *plan, runner_options(*plan, folder, arguments.jobs),
                         arguments.shards);
  }
  const int processors = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const int jobs = arguments.jobs > 0 ? arguments.jobs : processors;
  RunnerOptions options = runner_options(*plan, folder, jobs);
  // The folder of a shard is on a disk that many share, and of its logs few are kept.
  std::optional<PrivateDirectory> scratch;
  if (!plan->origin.shard.whole()) {
    scratch.emplace(fs::temp_directory_path(ignored).string());
    options.scratch = scratch->path();
  }
  return play_locally(context, *plan, options);
}

int merge(const Context& context, const MergeArguments& arguments) {
  const auto failed = [&](const std::string& why) {
    return fail(context, kFailed, "campaign merge", why);
  };
  std::string error;
  std::vector<fs::path> folders;
  for (const std::string& folder : arguments.folders) folders.push_back(fs::absolute(folder));
  auto plan = plan_of_folder(folders.front(), &error);
  if (!plan) return failed(error);
  plan->origin.shard = {};
  const fs::path target = fs::absolute(arguments.output).lexically_normal();
  CampaignFolder taken;
  CampaignResults results;
  if (!taken.take(target, *plan, &error) ||
      !merge_folders(*plan, folders, target, &results, &error)) {
    return failed(error);
  }
  return conclude(context, *plan, results, runner_options(*plan, target, 1)) ? kDone : kFailed;
}

void add_merge_command(CLI::App* campaign, Context* context) {
  auto* command = campaign->add_subcommand("merge", "Put the shards of a campaign together");
  command->footer(
      "The folder is that of a campaign that one machine has played, to the byte, whatever the "
      "order of the shards; with shards missing, of one that has not ended. Exit code 0 only if "
      "every combination succeeds as often as the file asks for.");
  auto arguments = std::make_shared<MergeArguments>();
  command->add_option("FOLDER", arguments->folders, "Folders of the shards")
      ->required()
      ->type_name("FOLDER");
  command->add_option("-o,--output", arguments->output, "Folder for all of them together")
      ->required()
      ->type_name("FOLDER");
  command->callback([context, arguments] {
    context->action = [context, arguments] { return merge(*context, *arguments); };
  });
}

}  // namespace

void add_campaign_command(CLI::App* app, Context* context) {
  auto* command = app->add_subcommand(
      "campaign", "Play scenarios with many settings and seeds on all processors, or a cluster");
  command->footer(
      "Started again after an end of any kind it goes on where it was. Exit code 0 only if every "
      "combination succeeds as often as the file asks for; 4 if the log of a run is damaged.");
  auto arguments = std::make_shared<CampaignArguments>();
  command->add_option("FILE", arguments->file, "A campaign (schema gaitd.campaign/1)")
      ->type_name("FILE");
  command
      ->add_option("-o,--output", arguments->folder,
                   "Folder for results, summary and the logs of the worst runs; by default the "
                   "name of the file and -results")
      ->type_name("FOLDER");
  add_settings(command, context, &arguments->settings,
               "Any key of the configuration or the scenario, for every run; may be repeated");
  command->add_flag("--trust", arguments->trust,
                    "Load libraries that the campaign or its scenarios name by path");
  command
      ->add_option("--jobs", arguments->jobs,
                   "Runs at once; by default as many as there are processors. Of slurm: shards at "
                   "once, by default as many as the cluster lets")
      ->check(CLI::Range(1, 100000));
  command->add_option("--engine", arguments->engine, "Where: on this machine, or by an array job")
      ->check(CLI::IsMember({"local", "slurm"}))
      ->capture_default_str();
  command
      ->add_option("--shards", arguments->shards,
                   "Of slurm: tasks to cut the campaign into; by default 100")
      ->check(CLI::Range(1, 100000));
  command
      ->add_option("--shard", arguments->shard,
                   "Play the I-th of N parts only, in a folder of its own; see campaign merge")
      ->type_name("I/N")
      ->check([](const std::string& text) {
        return parse_shard(text) ? "" : text + ": expected I/N, for example 2/4";
      });
  command->add_flag("--resume", arguments->resume,
                    "Go on where it was, and only that: an error where nothing was started");
  add_merge_command(command, context);
  add_page_command(command, context);
  add_tune_command(command, context);
  command->require_subcommand(0, 1);
  command->callback([context, command, arguments] {
    if (!command->get_subcommands().empty()) return;
    context->action = [context, arguments] { return run(*context, *arguments); };
  });
}

}  // namespace gaitd::cli
