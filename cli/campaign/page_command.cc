// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/page_command.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <system_error>

#include "cli/campaign/page_data.h"
#include "cli/campaign/pairs.h"
#include "cli/campaign/plan.h"
#include "cli/campaign/results.h"
#include "cli/campaign/runner.h"
#include "cli/doctor/log_doctor.h"
#include "cli/failure.h"
#include "cli/installed_page.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "cli/report/report_data.h"
#include "cli/whole_file.h"
#include "daemon/log/log_reader.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct PageArguments {
  std::string folder;
  std::string output = "campaign.html";
  bool replays = false;
};

// What the log of a run says, and its replay in `replays` beside the page, where one is asked for.
std::optional<json> log_json(int number, const fs::path& log_file, const fs::path& page,
                             bool replays, std::string* error) {
  std::vector<std::unique_ptr<daemon::LogReader>> logs;
  std::string unreadable;
  logs.push_back(daemon::LogReader::open(log_file.string(), &unreadable));
  if (!logs.back() || logs.back()->tick_count() == 0) {
    return json{{"run", number}, {"unreadable", unreadable.empty() ? "no tick" : unreadable}};
  }
  const std::string shown = campaign_log(fs::path(), number).string();
  json entry = doctor::diagnosis_json(shown, doctor::diagnose_log(*logs.back()));
  entry["run"] = number;
  if (!replays) return entry;
  const fs::path folder = fs::path(page).replace_extension("") += "-replays";
  const fs::path replay = folder / log_file.filename().replace_extension(".html");
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  const std::string text = report_page(report_data(logs), error);
  if (text.empty() || !write_file(replay, text, error)) return std::nullopt;
  entry["replay"] = (folder.filename() / replay.filename()).string();
  return entry;
}

int run(const Context& context, const PageArguments& arguments) {
  const auto failed = [&](const std::string& why) {
    return fail(context, kFailed, "campaign report", why);
  };
  std::string error;
  const fs::path folder = fs::absolute(arguments.folder).lexically_normal();
  const auto plan = plan_of_folder(folder, &error);
  if (!plan) return failed(error);
  const ResultFormat format(plan->campaign, plan->runs);
  const auto results = read_results(folder / "results.csv", format, &error);
  if (!results) return failed(error);
  if (results->empty()) return failed(folder.string() + ": holds no results yet");
  const RunnerOptions options{{}, folder, plan->settings, 1, plan->origin.trust};

  std::optional<Waiting> waiting("drawing " + arguments.output);
  json data = page_data(*plan, *results, options);
  data["comparisons"] = comparisons_json(*plan, *results);
  data["logs"] = json::array();
  for (const auto& [number, result] : *results) {
    if (!has_log(folder, number)) continue;
    auto log =
        log_json(number, campaign_log(folder, number), arguments.output, arguments.replays, &error);
    if (!log) return failed(error);
    data["logs"].push_back(std::move(*log));
  }
  const std::string page =
      page_with_data("campaign", "the page of campaigns", script_text(data), &error);
  if (page.empty() || !write_file(arguments.output, page, &error)) return failed(error);
  waiting.reset();
  if (context.json) {
    std::cout << json_text(
        {{"report", arguments.output}, {"runs", results->size()}, {"logs", data["logs"].size()}});
  } else {
    std::cout << "report: " << arguments.output << "\n";
  }
  return kDone;
}

}  // namespace

void add_page_command(CLI::App* campaign, Context* context) {
  auto* command = campaign->add_subcommand(
      "report", "A page of rates, maps, distributions and comparisons; one file, no network");
  command->footer(
      "Of a campaign that is still being played it shows what there is. Variants are compared on "
      "runs that differ in nothing else, and each run leads to what its log says, where one was "
      "kept.");
  auto arguments = std::make_shared<PageArguments>();
  command->add_option("FOLDER", arguments->folder, "Folder of a campaign")
      ->required()
      ->type_name("FOLDER");
  command->add_option("-o,--output", arguments->output, "Page to write")
      ->type_name("FILE")
      ->capture_default_str();
  command->add_flag("--replays", arguments->replays,
                    "Beside the page, a folder with the 3-D replay of each log; 5 MB a minute");
  command->callback([context, arguments] {
    context->action = [context, arguments] { return run(*context, *arguments); };
  });
}

}  // namespace gaitd::cli
