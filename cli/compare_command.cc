// SPDX-License-Identifier: Apache-2.0
#include "cli/compare_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/failure.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "cli/scenario_run.h"
#include "cli/table.h"
#include "daemon/config/daemon_config.h"
#include "daemon/config/paths.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct CompareArguments {
  std::string scenario;
  std::vector<std::string> overlays;
  std::string folder;
  bool trust = false;
};

// A gaitd.yaml as KEY=VALUE, over what the scenario sets.
std::vector<std::string> settings_of(const std::string& overlay, std::string* error) {
  daemon::Settings settings;
  daemon::Issues issues;
  std::vector<std::string> assignments;
  if (!daemon::load_config_file(overlay, &settings, &issues)) {
    *error = issues.error_text();
    return assignments;
  }
  for (const auto& entry : settings.from(daemon::SettingSource::kConfig)) {
    assignments.push_back(entry.key + "=" + daemon::to_json(*entry.value).dump());
  }
  return assignments;
}

std::string cell(double value, const std::string& unit) {
  if (!std::isfinite(value)) return "-";
  char text[40];
  std::snprintf(text, sizeof(text), "%.4g", value);
  return unit.empty() ? text : std::string(text) + " " + unit;
}

// Of a unit: what is less is nearly nothing, and so would be the sense of a percentage of it.
double least(const std::string& unit) {
  if (unit == "us") return 1.0;
  if (unit == "N m") return 0.1;
  return 1e-3;  // m, rad, s and what has no unit
}

std::string change(double a, double b, const std::string& unit) {
  if (!std::isfinite(a) || !std::isfinite(b)) return "";
  if (a == b) return "=";
  if (std::abs(a) < least(unit)) return (b > a ? "+" : "") + cell(b - a, unit);
  char text[32];
  std::snprintf(text, sizeof(text), "%+.1f %%", 100.0 * (b - a) / std::abs(a));
  return text;
}

using Runs = std::array<RunReport, 2>;

std::string text_of(const CompareArguments& arguments, const Runs& runs) {
  const std::string names[] = {fs::path(arguments.overlays[0]).stem().string(),
                               fs::path(arguments.overlays[1]).stem().string()};
  std::vector<std::vector<std::string>> rows;
  for (const daemon::Figure& figure : runs[0].verdict->figures) {
    const double other = runs[1].verdict->figure(figure.name);
    rows.push_back({figure.name, cell(figure.value, figure.unit), cell(other, figure.unit),
                    change(figure.value, other, figure.unit)});
  }
  for (const daemon::Judgement& judgement : runs[0].verdict->judgements) {
    const auto& others = runs[1].verdict->judgements;
    const auto other = std::find_if(others.begin(), others.end(),
                                    [&](const auto& j) { return j.name == judgement.name; });
    const auto mark = [](bool pass) { return pass ? " ok" : " FAIL"; };
    rows.push_back({"expect " + judgement.name, judgement.figure + mark(judgement.pass),
                    other == others.end() ? "-" : other->figure + mark(other->pass),
                    judgement.bound});
  }
  return table({arguments.scenario, names[0], names[1], "change"}, rows);
}

json json_of(const CompareArguments& arguments, const Runs& runs) {
  json figures;
  for (const daemon::Figure& figure : runs[0].verdict->figures) {
    const double other = runs[1].verdict->figure(figure.name);
    const auto value = [](double v) { return std::isfinite(v) ? json(v) : json(); };
    figures[figure.name] = {value(figure.value), value(other)};
  }
  return {{"scenario", arguments.scenario},
          {"configurations", arguments.overlays},
          {"figures", std::move(figures)},
          {"runs", {report_json(runs[0]), report_json(runs[1])}}};
}

int compare(const Context& context, const CompareArguments& arguments) {
  Runs runs;
  for (int i = 0; i < 2; ++i) {
    const std::string& overlay = arguments.overlays[i];
    std::string error;
    RunOptions options{gaitd_program(), settings_of(overlay, &error), {}, arguments.trust};
    if (!error.empty()) return fail(context, kFailed, "compare", error);
    if (!arguments.folder.empty()) {
      options.log = fs::path(arguments.folder) / (std::string(1, static_cast<char>('a' + i)) + "-" +
                                                  fs::path(overlay).stem().string() + ".mcap");
    }
    runs[i] =
        run_with_progress(arguments.scenario, options, arguments.scenario + " with " + overlay);
    if (!runs[i].verdict) {
      std::string why = overlay + ":";
      for (const std::string& problem : runs[i].problems) why += " " + problem;
      return fail(context, kFailed, "compare", why);
    }
  }
  std::cout << (context.json ? json_text(json_of(arguments, runs)) : text_of(arguments, runs));
  bool damaged = false;
  for (const RunReport& report : runs) {
    damaged |= report.damaged;
    for (const std::string& problem : report.problems) {
      std::cerr << "gaitctl: compare: " << report.log << ": " << problem << "\n";
    }
  }
  return damaged ? kDamaged : kDone;
}

}  // namespace

void add_compare_command(CLI::App* app, Context* context) {
  auto* command = app->add_subcommand(
      "compare", "Play a scenario under two configurations and show the figures side by side");
  command->footer(
      "A.yaml and B.yaml are configurations as gaitd.yaml, laid over what the scenario sets, e.g.\n"
      "  schema: gaitd.config/1\n"
      "  step_adjuster: {variant: fixed_steps}\n"
      "Exit code 0 if both were played, whatever their verdicts; 4 if a log is damaged.");
  auto arguments = std::make_shared<CompareArguments>();
  const auto* scenario =
      command->add_option("SCENARIO", arguments->scenario, "Name of a scenario, or its file")
          ->required()
          ->type_name("NAME|FILE");
  context->values[scenario] = [](const auto&) { return daemon::Paths::detect().scenarios(); };
  command->add_option("CONFIGURATION", arguments->overlays, "The two configurations")
      ->required()
      ->expected(2)
      ->type_name("FILE");
  command->add_option("--log", arguments->folder, "Folder for both logs")->type_name("FOLDER");
  command->add_flag("--trust", arguments->trust,
                    "Load libraries that the scenario or its robot.yaml names by path");
  command->callback([context, arguments] {
    context->action = [context, arguments] { return compare(*context, *arguments); };
  });
}

}  // namespace gaitd::cli
