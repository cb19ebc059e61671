// SPDX-License-Identifier: Apache-2.0
#include "cli/tune/tune_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <thread>

#include "cli/campaign/plan.h"
#include "cli/failure.h"
#include "cli/setting_option.h"
#include "cli/tune/cma_es.h"
#include "cli/tune/tuning.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

struct TuneArguments {
  std::string file;
  std::string folder;
  std::vector<std::string> settings;
  std::string engine = "local";
  int shards = 0;
  int jobs = 0;
  bool trust = false;
};

// Why this cannot be tuned; empty if it can.
std::string wrong_tuning(const CampaignPlan& plan) {
  std::error_code ignored;
  if (!plan.campaign.tune) {
    return plan.origin.file + ": expected a section 'tune', got none; gaitctl campaign plays it";
  }
  for (const std::string& setting : plan.settings) {
    for (const TunedParameter& parameter : plan.campaign.tune->parameters) {
      if (!setting.starts_with(parameter.key + "=")) continue;
      return "--set " + setting + ": is tuned; leave it out here or in 'tune'";
    }
  }
  if (!fs::exists(cma_es_program(), ignored)) {
    return cma_es_program().string() +
           ": no such program; install the package gaitd-tune, or build gaitd where libpagmo-dev "
           "is "
           "installed";
  }
  return "";
}

int run(const Context& context, const TuneArguments& arguments) {
  const auto failed = [&](const std::string& why) {
    return fail(context, kFailed, "campaign tune", why);
  };
  std::error_code ignored;
  if (!fs::exists(arguments.file, ignored)) {
    return failed(arguments.file + ": no such file; give the path of a campaign with 'tune'");
  }
  const fs::path file = fs::absolute(arguments.file).lexically_normal();
  std::string error;
  const auto plan = plan_of_file({file.string(), arguments.settings, arguments.trust, {}}, &error);
  if (!plan) return failed(error);
  if (const std::string why = wrong_tuning(*plan); !why.empty()) return failed(why);
  const fs::path folder =
      fs::absolute(arguments.folder.empty() ? file.stem().string() + "-tuned" : arguments.folder)
          .lexically_normal();
  CampaignFolder taken;
  if (!taken.take(folder, *plan, &error)) return failed(error);
  const int processors = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const bool local = arguments.engine == "local";
  const int jobs = arguments.jobs > 0 || !local ? arguments.jobs : processors;
  return tune(context, *plan, {folder, arguments.engine, jobs, arguments.shards});
}

}  // namespace

void add_tune_command(CLI::App* campaign, Context* context) {
  auto* command = campaign->add_subcommand(
      "tune", "Find parameters that succeed more often, and try them on what they never saw");
  command->footer(
      "The file has a section 'tune'. Generations of candidates are played with the same seeds, "
      "then "
      "the neighbours of the winner, and at last the winner and the defaults on seeds and "
      "scenarios "
      "that were held out. Started again after an end of any kind it goes on where it was. Exit "
      "code 0 "
      "only if the winner is better there and no neighbour loses a run that it holds.");
  auto arguments = std::make_shared<TuneArguments>();
  command->add_option("FILE", arguments->file, "A campaign with 'tune' (schema gaitd.campaign/1)")
      ->required()
      ->type_name("FILE");
  command
      ->add_option(
          "-o,--output", arguments->folder,
          "Folder for candidates, winner and each part as a campaign of its own; by default "
          "the name of the file and -tuned")
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
  command->add_option("--engine", arguments->engine, "Where: on this machine, or by array jobs")
      ->check(CLI::IsMember({"local", "slurm"}))
      ->capture_default_str();
  command
      ->add_option("--shards", arguments->shards,
                   "Of slurm: tasks to cut each part into; by default 100")
      ->check(CLI::Range(1, 100000));
  command->callback([context, arguments] {
    context->action = [context, arguments] { return run(*context, *arguments); };
  });
}

}  // namespace gaitd::cli
