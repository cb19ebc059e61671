// SPDX-License-Identifier: Apache-2.0
#include "cli/replay_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/failure.h"
#include "cli/log_damage.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "cli/setting_option.h"
#include "cli/table.h"
#include "daemon/config/paths.h"
#include "daemon/replay/replay.h"

namespace gaitd::cli {
namespace {

using daemon::ReplayReport;
using daemon::SignalDifference;
using nlohmann::json;

constexpr std::size_t kShown = 20;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.17g", value);
  return text;
}

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.4g", value);
  return text;
}

json report_json(const std::string& file, const ReplayReport& report) {
  json differences = json::array();
  for (const SignalDifference& d : report.differences) {
    differences.push_back({{"signal", d.signal},
                           {"layer", d.stage},
                           {"tick", d.tick},
                           {"recorded", d.recorded},
                           {"replayed", d.replayed},
                           {"largest", d.largest}});
  }
  return {{"file", file},
          {"ticks", report.ticks},
          {"signals", report.signals},
          {"identical", report.differences.empty()},
          {"differences", std::move(differences)},
          {"notes", report.notes}};
}

std::string report_text(const std::string& file, const ReplayReport& report) {
  std::string out;
  for (const std::string& note : report.notes) out += "note: " + note + "\n";
  const std::string compared =
      std::to_string(report.signals) + " signals in " + std::to_string(report.ticks) + " ticks";
  if (report.differences.empty()) return out + file + ": identical, " + compared + "\n";
  const SignalDifference& first = report.differences.front();
  out += file + ": " + std::to_string(report.differences.size()) + " of " + compared +
         " differ; the first in tick " + std::to_string(first.tick) + ", " + first.stage + ", " +
         first.signal + ": recorded " + number(first.recorded) + ", replayed " +
         number(first.replayed) + "\n";
  std::vector<std::vector<std::string>> rows;
  for (const SignalDifference& d : report.differences) {
    if (rows.size() == kShown) break;
    rows.push_back({std::to_string(d.tick), d.stage, d.signal, short_number(d.recorded),
                    short_number(d.replayed), short_number(d.largest)});
  }
  out +=
      table({"first tick", "layer", "signal", "recorded", "replayed", "largest difference"}, rows);
  if (report.differences.size() > kShown) {
    out += "and " + std::to_string(report.differences.size() - kShown) + " more; --json has all\n";
  }
  return out;
}

struct ReplayArguments {
  std::string file;
  std::vector<std::string> set;
  bool trust = false;
};

int replay(const Context& context, const ReplayArguments& arguments) {
  const std::string& file = arguments.file;
  std::string error;
  const auto log = daemon::LogReader::open(file, &error);
  if (!log) return fail(context, kFailed, "log replay", error);
  daemon::ReplayOptions options;
  options.plugin_folders = daemon::Paths::detect().plugin_folders();
  options.set = arguments.set;
  options.trust = arguments.trust;
  std::optional<Waiting> waiting("replaying " + file);
  const auto report = daemon::replay(*log, options, &error);
  waiting.reset();
  if (!report) return fail(context, kFailed, "log replay", error);
  if (context.json) {
    json result = report_json(file, *report);
    add_damage(*log, &result);
    std::cout << json_text(result);
  } else {
    std::cout << report_text(file, *report);
  }
  // With another layer the difference is what was asked for.
  const bool as_wanted = report->differences.empty() || !arguments.set.empty();
  return tell_damage("log replay", *log, as_wanted ? kDone : kFailed);
}

}  // namespace

void add_replay_command(CLI::App* log, Context* context) {
  auto* command = log->add_subcommand(
      "replay", "Compute every layer again from the recorded inputs, and compare bit by bit");
  command->footer(
      "Exit code 0 if every signal of every tick is what was recorded; else the first tick, layer\n"
      "and signal that differ are named. With --set the difference that it makes is shown. It\n"
      "needs the log, the installed plugins and no daemon; wall times and the simulation are not\n"
      "replayed. 4: the log is damaged, and was replayed up to the first tick that is missing.");
  auto arguments = std::make_shared<ReplayArguments>();
  command->add_option("FILE", arguments->file, "A log of gaitd (.mcap)")
      ->required()
      ->type_name("FILE");
  add_settings(
      command, context, &arguments->set,
      "Change a configuration key, e.g. whole_body_controller.variant=com_height_qp; may be "
      "repeated");
  command->add_flag("--trust", arguments->trust,
                    "Load a library from where the log says that it was, if the installed one is "
                    "another");
  command->callback([context, arguments] {
    context->action = [context, arguments] { return replay(*context, *arguments); };
  });
}

}  // namespace gaitd::cli
