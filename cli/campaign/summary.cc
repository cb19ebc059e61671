// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/summary.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <system_error>

#include "cli/campaign/calibration.h"
#include "cli/campaign/groups.h"
#include "cli/campaign/labels.h"
#include "cli/campaign/replay_text.h"
#include "cli/campaign/runner.h"
#include "cli/campaign/statistics.h"
#include "cli/campaign/sweep.h"
#include "cli/print.h"
#include "cli/table.h"
#include "daemon/verdict/number_text.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kWorstRuns = 10;

std::string describe_run(const Campaign& campaign, const CampaignRun& run) {
  std::string text = run.scenario;
  for (const std::string& assignment : assignments(campaign, run)) text += " " + assignment;
  return text;
}

// With names for people beside the values.
void add_settings(const Campaign& campaign, const std::vector<std::string>& values, json* cell) {
  json& settings = (*cell)["set"] = json::object();
  json& labels = (*cell)["labels"] = json::object();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string& key = campaign.settings[i].key;
    settings[key] = values[i];
    labels[key] = value_label(campaign, key, values[i]);
  }
}

std::string settings_text(const json& settings) {
  std::string text;
  for (const auto& [key, value] : settings.items()) {
    text += (text.empty() ? "" : " ") + key + "=" + value.get<std::string>();
  }
  return text;
}

json or_null(const std::optional<double>& value) { return value ? json(*value) : json(); }

// Cells of a search. False if one is not finished.
bool add_found(const Campaign& campaign, RunOrder* order, json* cells) {
  bool finished = true;
  for (const SearchResult& found : order->found()) {
    finished = finished && found.finished;
    json cell = {{"scenario", found.scenario},
                 {"finished", found.finished},
                 {"runs", found.runs},
                 {"successes", found.successes},
                 {"limit", or_null(found.limit)},
                 {"low", or_null(found.low)},
                 {"high", or_null(found.high)}};
    add_settings(campaign, found.values, &cell);
    cells->push_back(std::move(cell));
  }
  return finished;
}

std::string short_text(const json& value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.4g", value.get<double>());
  return text;
}

// An interval with an end beyond what was tried.
std::string open_text(const json& cell) {
  if (!cell["low"].is_null()) return "≥ " + short_text(cell["low"]);
  return cell["high"].is_null() ? "not known" : "≤ " + short_text(cell["high"]);
}

std::vector<std::string> limit_texts(const json& cell) {
  if (!cell["finished"].get<bool>()) return {"not finished", ""};
  const bool open = cell["low"].is_null() || cell["high"].is_null();
  const std::string interval =
      open ? open_text(cell) : short_text(cell["low"]) + " .. " + short_text(cell["high"]);
  return {cell["limit"].is_null() ? open_text(cell) : short_text(cell["limit"]), interval};
}

std::string search_text(const json& summary, std::size_t columns) {
  std::vector<std::vector<std::string>> rows;
  for (const json& cell : summary["cells"]) {
    const std::vector<std::string> limit = limit_texts(cell);
    rows.push_back(
        {cell["scenario"], limit[0], limit[1], cell["runs"].dump(), settings_text(cell["labels"])});
  }
  char rate[16];
  std::snprintf(rate, sizeof(rate), "%g", 100.0 * summary["search"]["rate"].get<double>());
  return "limit: " + summary["search"]["key"].get<std::string>() + " at which " + rate +
         " % of the runs succeed\n" +
         table({"SCENARIO", "LIMIT", "95 % INTERVAL", "RUNS", "SETTINGS"}, rows, columns);
}

std::string rates_text(const json& summary, std::size_t columns) {
  std::vector<std::vector<std::string>> rows;
  for (const json& cell : summary["cells"]) {
    // Of the many cells of a sweep only those that fail.
    if (cell["set"].contains(kSweptSetting) && cell["success_rate"] >= summary["success_min"]) {
      continue;
    }
    rows.push_back({cell["scenario"], cell["successes"].dump() + "/" + cell["runs"].dump(),
                    percent_text(cell["success_rate"]),
                    percent_text(cell["low"]) + " .. " + percent_text(cell["high"]),
                    cell["falls"].dump(), cell["refusals"].dump(), settings_text(cell["labels"])});
  }
  return table({"SCENARIO", "SUCCESS", "RATE", "95 % INTERVAL", "FALLS", "REFUSED", "SETTINGS"},
               rows, columns);
}

json search_json(const Campaign& campaign) {
  if (!campaign.search) return nullptr;
  return {{"key", campaign.settings.back().key},
          {"rate", campaign.search->rate},
          {"from", campaign.search->from},
          {"to", campaign.search->to},
          {"width", campaign.search->width}};
}

}  // namespace

json summary_json(const Campaign& campaign, const std::vector<CampaignRun>& runs,
                  const CampaignResults& results, RunOrder* order, const RunnerOptions& options,
                  const fs::path& shown) {
  json cells = json::array();
  int total = 0, unjudged = 0;
  bool pass = order->remaining() == 0;
  std::map<int, std::pair<int, int>> counts;  // successes and runs by cell
  std::map<int, int> falls, refusals;
  for (const auto& [number, result] : results) {
    const int cell = runs[static_cast<std::size_t>(number) - 1].cell;
    counts[cell].first += result.success ? 1 : 0;
    counts[cell].second += 1;
    falls[cell] += result.fell ? 1 : 0;
    refusals[cell] += result.refused ? 1 : 0;
    total += result.success ? 1 : 0;
    unjudged += result.problem.empty() ? 0 : 1;
  }
  if (campaign.search) pass = add_found(campaign, order, &cells) && pass;
  for (const auto& [cell, count] : counts) {
    if (campaign.search) break;
    const CampaignRun& run = runs[static_cast<std::size_t>(cell)];  // of the first seed
    const SuccessInterval interval = wilson_interval(count.first, count.second);
    const double rate = static_cast<double>(count.first) / count.second;
    pass = pass && rate >= campaign.success_min;
    json entry = {{"scenario", run.scenario},   {"runs", count.second},
                  {"successes", count.first},   {"falls", falls[cell]},
                  {"refusals", refusals[cell]}, {"success_rate", rate},
                  {"low", interval.low},        {"high", interval.high}};
    add_settings(campaign, run.values, &entry);
    cells.push_back(std::move(entry));
  }
  std::vector<const CampaignResult*> worst = worst_first(results);
  worst.resize(std::min(worst.size(), kWorstRuns));
  json worst_runs = json::array();
  for (const CampaignResult* result : worst) {
    const CampaignRun& run = runs[static_cast<std::size_t>(result->number) - 1];
    const bool logged = has_log(options.folder, result->number);
    json entry = {{"run", result->number},
                  {"what", describe_run(campaign, run)},
                  {"success", result->success},
                  {"fell", result->fell},
                  {"failed", result->failed},
                  {"problem", result->problem},
                  {"log", logged ? json(campaign_log(shown, result->number).string()) : json()},
                  {"replay", replay_text(campaign, run, options, shown)}};
    for (std::size_t i = 0; i < campaign_figures().size(); ++i) {
      const double figure = result->figures[i];
      entry["figures"][campaign_figures()[i]] = std::isnan(figure) ? json() : json(figure);
    }
    worst_runs.push_back(entry);
  }
  json without_runs;
  const json targets = targets_json(campaign, runs, results, &without_runs);
  for (const json& target : targets) pass = pass && target["pass"].get<bool>();
  return {{"campaign", campaign.name},
          {"pass", pass},
          {"runs", results.size() + order->remaining()},
          {"finished", results.size()},
          {"successes", total},
          {"unjudged", unjudged},
          {"success_min", campaign.success_min},
          {"search", search_json(campaign)},
          {"cells", cells},
          {"groups", groups_json(campaign, runs, results)},
          {"targets", targets},
          {"targets_without_runs", without_runs},
          {"worst", worst_runs},
          {"folder", shown.string()},
          {"results", (shown / "results.csv").string()}};
}

std::string summary_text(const json& summary, std::size_t columns) {
  std::string text = summary["campaign"].get<std::string>() + ": " + summary["finished"].dump() +
                     " of " + summary["runs"].dump() + " runs, " + summary["successes"].dump() +
                     " succeeded\n\n";
  if (const int unjudged = summary["unjudged"].get<int>(); unjudged > 0) {
    text +=
        std::to_string(unjudged) +
        " runs could not be judged: they count as failures below, and as nothing where variants "
        "are compared; the same command plays them again\n\n";
  }
  const std::string groups = groups_text(summary["groups"], columns);
  if (!summary["search"].is_null()) {
    text += search_text(summary, columns);
  } else {
    text += groups.empty() ? rates_text(summary, columns) : groups;
  }
  const std::string targets = targets_text(summary["targets"], summary["targets_without_runs"]);
  if (!targets.empty()) text += "\ntargets\n" + targets;
  text += "\nworst runs\n";
  for (const json& run : summary["worst"]) {
    const std::string failed = run["failed"].get<std::string>();
    const std::string problem = run["problem"].get<std::string>();
    const json& icp = run["figures"]["icp_error_max"];
    text +=
        "  " + std::string(run["success"].get<bool>() ? "ok    " : "FAIL  ") +
        run["what"].get<std::string>() +
        (icp.is_null() ? "" : "  icp_error_max " + daemon::number_text(icp.get<double>(), "m")) +
        (run["fell"].get<bool>() ? "  fell" : "") +
        (failed.empty() ? "" : "  not held: " + failed) + (problem.empty() ? "" : "  " + problem) +
        "\n" + (run["log"].is_null() ? "" : "        " + run["log"].get<std::string>() + "\n");
  }
  if (!summary["worst"].empty()) {
    const bool from_here = summary["folder"].get<std::string>().empty();
    text += "\nthe worst again" + std::string(from_here ? ", from this folder" : "") + ": " +
            summary["worst"][0]["replay"].get<std::string>() + "\n";
  }
  text += "\nresults: " + summary["results"].get<std::string>() + "\n";
  text += summary["pass"].get<bool>() ? "campaign: passed\n" : "campaign: FAILED\n";
  return text;
}

}  // namespace gaitd::cli
