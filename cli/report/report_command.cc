// SPDX-License-Identifier: Apache-2.0
#include "cli/report/report_command.h"

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
#include "cli/report/pictures.h"
#include "cli/report/report_data.h"
#include "daemon/log/log_reader.h"

namespace gaitd::cli {
namespace {

struct ReportArguments {
  std::vector<std::string> logs;
  std::string output = "report.html";
  std::string png;
  std::string film;
  std::vector<double> span;  // s, of the film
};

int run(const Context& context, const ReportArguments& arguments) {
  std::string error;
  std::optional<Waiting> waiting("drawing " + arguments.output);
  std::vector<std::unique_ptr<daemon::LogReader>> logs;
  std::size_t ticks = 0;
  for (const std::string& file : arguments.logs) {
    logs.push_back(daemon::LogReader::open(file, &error));
    if (!logs.back()) return fail(context, kFailed, "report", error);
    if (logs.back()->tick_count() == 0) {
      return fail(context, kFailed, "report", file + ": holds no tick, nothing to show");
    }
    ticks += logs.back()->tick_count();
  }
  const std::string page = report_page(report_data(logs), &error);
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
  if (!arguments.film.empty()) {
    const std::vector<double> time = logs.front()->column("time");
    const bool whole = arguments.span.empty();
    error = draw_film(arguments.output, arguments.film, whole ? time.front() : arguments.span[0],
                      whole ? time.back() : arguments.span[1]);
    if (!error.empty()) return fail(context, kFailed, "report", error);
  }
  waiting.reset();
  if (context.json) {
    nlohmann::json result = {{"report", arguments.output}, {"ticks", ticks}};
    if (logs.size() == 1) add_damage(*logs.front(), &result);
    for (std::size_t i = 0; logs.size() > 1 && i < logs.size(); ++i) {
      nlohmann::json one = {{"file", arguments.logs[i]}, {"ticks", logs[i]->tick_count()}};
      add_damage(*logs[i], &one);
      result["logs"].push_back(std::move(one));
    }
    std::cout << json_text(result);
  } else {
    std::cout << "report: " << arguments.output << "\n";
    if (!arguments.png.empty()) std::cout << "pictures: " << arguments.png << "\n";
    if (!arguments.film.empty()) std::cout << "film: " << arguments.film << "\n";
  }
  int code = kDone;
  for (const auto& log : logs) code = tell_damage("report", *log, code);
  return code;
}

}  // namespace

void add_report_command(CLI::App* app, Context* context) {
  auto* command = app->add_subcommand(
      "report", "A page that replays logs in 3-D beside their plots; one file, no network");
  command->footer(
      "Several logs are laid over each other: their lines in the same plots, the robots of all "
      "but\n"
      "the first as ghosts. Exit code 4: done, but a log is damaged; what is missing is said.");
  auto arguments = std::make_shared<ReportArguments>();
  command->add_option("FILE", arguments->logs, "Logs of gaitd (.mcap)")
      ->required()
      ->type_name("FILE");
  command->add_option("-o,--output", arguments->output, "Page to write")
      ->type_name("FILE")
      ->capture_default_str();
  command
      ->add_option("--png", arguments->png,
                   "Folder for pictures of the robot and of each plot; needs chromium")
      ->type_name("FOLDER");
  auto* film = command->add_option("--film", arguments->film,
                                   "Animated PNG of the robot as it moves; needs chromium");
  film->type_name("FILE");
  command->add_option("--film-span", arguments->span, "Time of the log that the film shows, s")
      ->type_name("FROM TO")
      ->expected(2)
      ->needs(film);
  command->callback([context, arguments] {
    context->action = [context, arguments] { return run(*context, *arguments); };
  });
}

}  // namespace gaitd::cli
