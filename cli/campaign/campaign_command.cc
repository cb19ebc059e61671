// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/campaign_command.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <system_error>
#include <thread>

#include "cli/campaign/calibration.h"
#include "cli/campaign/campaign.h"
#include "cli/campaign/plot.h"
#include "cli/campaign/progress.h"
#include "cli/campaign/results.h"
#include "cli/campaign/runner.h"
#include "cli/campaign/search.h"
#include "cli/campaign/settings.h"
#include "cli/campaign/summary.h"
#include "cli/failure.h"
#include "cli/print.h"
#include "cli/setting_option.h"
#include "cli/terminal.h"
#include "daemon/config/daemon_config.h"
#include "daemon/config/library_paths.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kInterrupted = 130;  // as a shell reports a program that SIGINT ended

struct Arguments {
  std::string file;
  std::string folder;
  std::vector<std::string> settings;
  int jobs = 0;
  bool trust = false;
};

// Makes the folder and takes it for this process, or says why not. A descriptor, or -1.
int take_folder(const fs::path& folder, const std::string& text, std::string* error) {
  std::error_code code;
  fs::create_directories(folder / "logs", code);
  if (code) {
    *error = "cannot make the folder " + folder.string() + ": " + code.message() +
             "; give another one with -o";
    return -1;
  }
  const int lock = open((folder / "lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock < 0 || flock(lock, LOCK_EX | LOCK_NB) != 0) {
    *error = folder.string() + ": another campaign is running in this folder";
    if (lock >= 0) close(lock);
    return -1;
  }
  const fs::path copy = folder / "campaign.yaml";
  if (fs::exists(copy, code)) {
    std::ifstream in(copy);
    if (std::string(std::istreambuf_iterator<char>(in), {}) != text) {
      *error = folder.string() + ": holds results of another campaign, or of this one before its " +
               "file or --set was changed; give another folder with -o, or delete this one";
      close(lock);
      return -1;
    }
  } else {
    std::ofstream(copy) << text;
  }
  return lock;
}

// KEY=VALUE of everything that a run may get from the file.
std::vector<std::string> all_assignments(const Campaign& campaign) {
  std::vector<std::string> all;
  for (const CampaignSetting& setting : campaign.settings) {
    for (const std::string& value : setting.values) {
      for (std::string& one : assignments(campaign, setting.key, value)) {
        all.push_back(std::move(one));
      }
    }
  }
  for (const CampaignDraw& draw : campaign.draws) {
    for (const std::string& value : draw.choices) all.push_back(draw.key + "=" + value);
  }
  return all;
}

// Why the campaign may not be played; empty if it may. Its settings reach gaitd as --set, where
// nobody could tell whose word they are.
std::string what_no_file_may_say(const Campaign& campaign, bool trust) {
  for (const std::string& assignment : all_assignments(campaign)) {
    daemon::Settings settings;
    daemon::Issues unreadable;  // gaitd will say so
    settings.set_assignment(assignment, &unreadable);
    for (const daemon::Settings::Entry& entry : daemon::library_paths(settings)) {
      if (trust) continue;
      return entry.key + "=" + entry.value->text +
             ": a file may not name code to run; name an installed variant, give the path with "
             "--set, or say --trust if you know the library";
    }
    for (const daemon::Settings::Entry& entry : settings.effective()) {
      if (!daemon::is_own_key(entry.key)) continue;
      return entry.key +
             ": a file may not say where gaitd writes, listens and finds plugins; remove it there, "
             "or give it with --set";
    }
  }
  return "";
}

void write_plots(const Campaign& campaign, const std::vector<SearchResult>& found,
                 const fs::path& folder) {
  for (const std::string& scenario : campaign.scenarios) {
    std::ofstream(folder / (fs::path(scenario).stem().string() + ".svg"))
        << polar_plot(campaign, found, scenario);
  }
}

PoolEnd calibrate(const Campaign& campaign, const std::vector<CampaignRun>& runs,
                  const RunnerOptions& options, const std::map<int, CampaignResult>& results,
                  CalibrationFailures* failures, std::string* error) {
  ProgressBar bar("calibrations ");
  const auto progress = [&](const ProgressCounts& counts) { bar.show(counts); };
  const PoolEnd end =
      make_calibrations(campaign, runs, options, results, progress, failures, error);
  bar.end();
  for (const auto& [file, why] : *failures) std::cerr << "gaitctl: campaign: " << why << "\n";
  return end;
}

PoolEnd play(const Campaign& campaign, const std::vector<CampaignRun>& runs,
             const RunnerOptions& options, const CalibrationFailures& failures, RunOrder* order,
             ResultFile* results, std::string* error) {
  ProgressBar bar("");
  const auto progress = [&](int finished) {
    int failed = 0;
    for (const auto& [number, result] : results->results()) failed += result.success ? 0 : 1;
    const std::size_t done = results->results().size();
    bar.show({done, done + order->remaining(), failed, finished});
  };
  const PoolEnd end = play_runs(campaign, runs, options, failures, order, results, progress, error);
  bar.end();
  return end;
}

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

int run(const Context& context, const Arguments& arguments) {
  std::error_code ignored;
  if (!fs::exists(arguments.file, ignored)) {
    return fail(context, kFailed, "campaign", missing_file(arguments.file));
  }
  daemon::Issues issues;
  std::optional<Campaign> campaign = load_campaign(arguments.file, &issues);
  if (!campaign) return fail(context, kFailed, "campaign", issues.error_text());
  if (const std::string why = what_no_file_may_say(*campaign, arguments.trust); !why.empty()) {
    return fail(context, kFailed, "campaign", arguments.file + ": " + why);
  }
  std::string error;
  std::vector<std::string> settings;  // those that are no settings of the campaign
  for (const std::string& setting : arguments.settings) {
    if (!narrow(&*campaign, setting, &error)) settings.push_back(setting);
    if (!error.empty()) return fail(context, kFailed, "campaign", error);
  }
  const fs::path folder =
      fs::absolute(arguments.folder.empty() ? fs::path(arguments.file).stem().string() + "-results"
                                            : arguments.folder);
  // What --set says makes another campaign of it.
  std::string text = campaign->text;
  for (const std::string& setting : arguments.settings) text += "# --set " + setting + "\n";
  const int lock = take_folder(folder, text, &error);
  if (lock < 0 || !write_drawn(*campaign, folder, &error)) {
    return fail(context, kFailed, "campaign", error);
  }

  const std::vector<CampaignRun> runs = expand(*campaign);
  ResultFile results(*campaign, runs);
  if (!results.open(folder / "results.csv", &error)) {
    return fail(context, kFailed, "campaign", error);
  }
  RunnerOptions options;
  options.gaitctl = fs::read_symlink("/proc/self/exe", ignored);
  options.folder = folder;
  options.settings = settings;
  options.trust = arguments.trust;
  options.jobs = arguments.jobs > 0
                     ? arguments.jobs
                     : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  RunOrder order(*campaign, runs, results.results());
  if (const std::size_t before = results.results().size(); before > 0) {
    std::cerr << "goes on: " << before << " of " << before + order.remaining()
              << (campaign->searches ? " runs at most are done\n" : " runs are done\n");
  }
  CalibrationFailures failures;
  PoolEnd end = calibrate(*campaign, runs, options, results.results(), &failures, &error);
  if (end == PoolEnd::kDone) {
    end = play(*campaign, runs, options, failures, &order, &results, &error);
  }
  close(lock);
  if (end == PoolEnd::kFailed) return fail(context, kFailed, "campaign", error);
  const nlohmann::json summary = summary_json(*campaign, runs, results.results(), &order, options);
  if (campaign->plot) write_plots(*campaign, order.found(), folder);
  std::ofstream(folder / "summary.txt") << summary_text(summary, 0);
  std::ofstream(folder / "summary.json") << json_text(summary);
  std::cout << (context.json ? json_text(summary) : summary_text(summary, output_columns()));
  if (end == PoolEnd::kInterrupted) {
    std::cerr << "interrupted; the same command goes on\n";
    return kInterrupted;
  }
  int damaged = 0;
  for (const auto& [number, result] : results.results()) damaged += result.damaged ? 1 : 0;
  if (damaged > 0) {
    std::cerr << "gaitctl: campaign: the logs of " << damaged
              << " runs are damaged; the same command plays them again\n";
    return kDamaged;
  }
  return summary["pass"].get<bool>() ? kDone : kFailed;
}

}  // namespace

void add_campaign_command(CLI::App* app, Context* context) {
  auto* command = app->add_subcommand(
      "campaign", "Play scenarios with many settings and seeds on all processors");
  command->footer(
      "Started again after an end of any kind it goes on where it was. Exit code 0 only if every "
      "combination succeeds as often as the file asks for; 4 if the log of a run is damaged.");
  auto arguments = std::make_shared<Arguments>();
  command->add_option("FILE", arguments->file, "A campaign (schema gaitd.campaign/1)")
      ->required()
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
                   "Runs at once; by default as many as there are processors")
      ->check(CLI::Range(1, 1024));
  command->callback([context, arguments] {
    context->action = [context, arguments] { return run(*context, *arguments); };
  });
}

}  // namespace gaitd::cli
