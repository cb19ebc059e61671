// SPDX-License-Identifier: Apache-2.0
#include "cli/log_commands.h"

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/failure.h"
#include "cli/log_damage.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "cli/replay_command.h"
#include "cli/table.h"
#include "daemon/log/export_csv.h"
#include "daemon/log/log_info.h"
#include "daemon/log/log_reader.h"

namespace gaitd::cli {
namespace {

using daemon::LogReader;

std::string signal_list(const LogReader& log) {
  std::vector<std::vector<std::string>> rows;
  for (const daemon::SignalDescription& signal : log.signals()) {
    std::string words;
    for (const std::string& word : signal.words) words += (words.empty() ? "" : ", ") + word;
    rows.push_back({signal.name, signal.unit, words});
  }
  return table({"signal", "unit", "words"}, rows);
}

std::string with_newline(std::string text) {
  if (!text.ends_with('\n')) text += '\n';
  return text;
}

int show_info(const Context& context, const std::string& file, bool signals) {
  std::string error;
  const auto log = LogReader::open(file, &error);
  if (!log) return fail(context, kFailed, "log info", error);
  if (context.json) {
    std::cout << with_newline(daemon::log_info_json(*log));
  } else if (signals) {
    std::cout << signal_list(*log);
  } else {
    std::cout << with_newline(daemon::log_info_text(*log));
  }
  return tell_damage("log info", *log, kDone);
}

struct ExportOptions {
  std::string file;
  std::string signals;
  std::string output;
};

int export_log(const Context& context, const ExportOptions& options) {
  const auto failed = [&](const std::string& why) {
    return fail(context, kFailed, "log export", why);
  };
  const bool to_file = !options.output.empty() && options.output != "-";
  if (context.json && !to_file) {
    return fail(context, kUsage, "log export",
                "with --json, standard output holds JSON: give a file for the CSV with -o FILE");
  }
  std::string error;
  const auto log = LogReader::open(options.file, &error);
  if (!log) return failed(error);
  daemon::CsvOptions csv;
  csv.signals = options.signals;
  std::ofstream file;
  if (to_file) {
    file.open(options.output, std::ios::binary | std::ios::trunc);
    if (!file) return failed(options.output + ": cannot write: " + std::strerror(errno));
  }
  std::ostream& out = to_file ? file : std::cout;
  std::optional<Waiting> waiting;
  if (to_file) waiting.emplace("writing " + options.output);
  if (!daemon::export_csv(*log, csv, out, &error)) return failed(error);
  waiting.reset();
  out.flush();
  if (!out) {
    return failed((to_file ? options.output : "output") +
                  ": cannot write: " + std::strerror(errno));
  }
  if (context.json) {
    nlohmann::json result = {{"file", options.output},
                             {"rows", log->tick_count()},
                             {"signals", log->match(options.signals)}};
    add_damage(*log, &result);
    std::cout << json_text(result);
  }
  return tell_damage("log export", *log, kDone);
}

}  // namespace

void add_log_commands(CLI::App* app, Context* context) {
  auto* log = app->add_subcommand("log", "Read a log file");
  log->footer("Exit code 4: done, but the log is damaged; what is missing is said.");
  log->require_subcommand(1);

  auto* info = log->add_subcommand("info", "What is in a log: length, signals, events, versions");
  auto file = std::make_shared<std::string>();
  auto list = std::make_shared<bool>(false);
  info->add_option("FILE", *file, "A log of gaitd (.mcap)")->required()->type_name("FILE");
  info->add_flag("--signals", *list, "List the signals with their units instead");
  info->callback([context, file, list] {
    context->action = [context, file, list] { return show_info(*context, *file, *list); };
  });

  add_replay_command(log, context);

  auto* csv = log->add_subcommand("export", "Signals as CSV, one row per tick");
  auto options = std::make_shared<ExportOptions>();
  csv->add_option("FILE", options->file, "A log of gaitd (.mcap)")->required()->type_name("FILE");
  csv->add_option("--signals", options->signals,
                  "Comma-separated globs, e.g. 'time,icp/*,foot/*/force/z'; all if left out")
      ->type_name("GLOBS");
  csv->add_option("-o,--output", options->output,
                  "File to write; standard output if left out. With --json it is needed")
      ->type_name("FILE");
  csv->callback([context, options] {
    context->action = [context, options] { return export_log(*context, *options); };
  });
}

}  // namespace gaitd::cli
