// SPDX-License-Identifier: Apache-2.0
#include "cli/log_commands.h"

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>

#include "daemon/telemetry/export_csv.h"
#include "daemon/telemetry/log_info.h"
#include "daemon/telemetry/log_reader.h"

namespace gaitd::cli {
namespace {

using daemon::LogReader;

int fail(const std::string& error) {
  std::cerr << "gaitctl: log: " << error << "\n";
  return kFailed;
}

std::string with_newline(std::string text) {
  if (!text.ends_with('\n')) text += '\n';
  return text;
}

int show_info(const std::string& file, bool json) {
  std::string error;
  const auto log = LogReader::open(file, &error);
  if (!log) return fail(error);
  std::cout << with_newline(json ? daemon::log_info_json(*log) : daemon::log_info_text(*log));
  return kDone;
}

int export_to(const LogReader& log, const daemon::CsvOptions& options, std::ostream& out,
              const std::string& name) {
  std::string error;
  if (!daemon::export_csv(log, options, out, &error)) return fail(error);
  out.flush();
  if (!out) return fail(name + ": cannot write: " + std::strerror(errno));
  return kDone;
}

int export_log(const std::string& file, const std::string& signals, const std::string& output) {
  std::string error;
  const auto log = LogReader::open(file, &error);
  if (!log) return fail(error);
  daemon::CsvOptions options;
  options.signals = signals;
  if (output.empty() || output == "-") return export_to(*log, options, std::cout, "output");
  std::ofstream out(output, std::ios::binary | std::ios::trunc);
  if (!out) return fail(output + ": cannot write: " + std::strerror(errno));
  return export_to(*log, options, out, output);
}

}  // namespace

void add_log_commands(CLI::App* app, Context* context) {
  auto* log = app->add_subcommand("log", "Read a log file");
  log->require_subcommand(1);
  auto file = std::make_shared<std::string>();
  auto signals = std::make_shared<std::string>();
  auto output = std::make_shared<std::string>();

  auto* info = log->add_subcommand("info", "What is in a log: length, signals, events, versions");
  info->add_option("FILE", *file, "A log of gaitd (.mcap)")->required();
  info->callback([context, file] {
    context->action = [context, file] { return show_info(*file, context->json); };
  });

  auto* csv = log->add_subcommand("export", "Signals as CSV, one row per tick");
  csv->add_option("FILE", *file, "A log of gaitd (.mcap)")->required();
  csv->add_option("--signals", *signals,
                  "Comma-separated globs, e.g. 'time,icp/*,foot/*/force/z'; all if left out");
  csv->add_option("-o,--output", *output, "File to write; standard output if left out");
  csv->callback([context, file, signals, output] {
    context->action = [file, signals, output] { return export_log(*file, *signals, *output); };
  });
}

}  // namespace gaitd::cli
