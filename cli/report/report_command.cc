// SPDX-License-Identifier: Apache-2.0
#include "cli/report/report_command.h"

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>

#include "cli/failure.h"
#include "cli/log_damage.h"
#include "cli/print.h"
#include "cli/report/pictures.h"
#include "cli/report/report_data.h"
#include "daemon/log/log_reader.h"

namespace gaitd::cli {
namespace {

struct Arguments {
  std::string log;
  std::string output = "report.html";
  std::string png;
};

int run(const Context& context, const Arguments& arguments) {
  std::string error;
  const auto log = daemon::LogReader::open(arguments.log, &error);
  if (!log) return fail(context, kFailed, "report", error);
  if (log->tick_count() == 0) {
    return fail(context, kFailed, "report", arguments.log + ": holds no tick, nothing to show");
  }
  const std::string page = report_page(report_data(*log), &error);
  if (page.empty()) return fail(context, kFailed, "report", error);
  std::ofstream out(arguments.output, std::ios::binary | std::ios::trunc);
  out << page << std::flush;
  if (!out) {
    return fail(context, kFailed, "report",
                arguments.output + ": cannot write: " + std::strerror(errno));
  }
  if (!arguments.png.empty()) {
    error = draw_pictures(arguments.output, arguments.png);
    if (!error.empty()) return fail(context, kFailed, "report", error);
  }
  if (context.json) {
    nlohmann::json result = {{"report", arguments.output}, {"ticks", log->tick_count()}};
    add_damage(*log, &result);
    std::cout << json_text(result);
  } else {
    std::cout << "report: " << arguments.output << "\n";
    if (!arguments.png.empty()) std::cout << "pictures: " << arguments.png << "\n";
  }
  return tell_damage("report", *log, kDone);
}

}  // namespace

void add_report_command(CLI::App* app, Context* context) {
  auto* command = app->add_subcommand(
      "report", "A page that replays a log in 3-D beside its plots; one file, no network");
  command->footer("Exit code 4: done, but the log is damaged; what is missing is said.");
  auto arguments = std::make_shared<Arguments>();
  command->add_option("FILE", arguments->log, "A log of gaitd (.mcap)")
      ->required()
      ->type_name("FILE");
  command->add_option("-o,--output", arguments->output, "Page to write")
      ->type_name("FILE")
      ->capture_default_str();
  command
      ->add_option("--png", arguments->png,
                   "Folder for pictures of the robot and of each plot; needs chromium")
      ->type_name("FOLDER");
  command->callback([context, arguments] {
    context->action = [context, arguments] { return run(*context, *arguments); };
  });
}

}  // namespace gaitd::cli
