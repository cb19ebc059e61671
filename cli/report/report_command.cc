// SPDX-License-Identifier: Apache-2.0
#include "cli/report/report_command.h"

#include <sys/wait.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>
#include <thread>

#include "cli/child.h"
#include "cli/failure.h"
#include "cli/print.h"
#include "cli/report/report_data.h"
#include "daemon/telemetry/log_reader.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

// As in the page: cli/report/page/src/plots.js.
constexpr std::array kPlots = {"icp-path", "icp-x",  "icp-y",           "com-height", "knees",
                               "torques",  "forces", "step-adjustment", "tick-times"};

constexpr std::chrono::seconds kBrowserTime(300);  // for one picture, on a busy machine

struct Arguments {
  std::string log;
  std::string output = "report.html";
  std::string png;
};

// The browser that draws the plots, or nothing.
fs::path find_browser() {
  const char* path = std::getenv("PATH");
  std::string rest = path == nullptr ? "" : path;
  while (!rest.empty()) {
    const std::size_t colon = rest.find(':');
    const fs::path file = fs::path(rest.substr(0, colon)) / "chromium";
    std::error_code ignored;
    if (fs::exists(file, ignored)) return file;
    rest = colon == std::string::npos ? "" : rest.substr(colon + 1);
  }
  return {};
}

// False if it had to be killed.
bool wait_for_child(pid_t pid, std::chrono::seconds most) {
  const auto end = std::chrono::steady_clock::now() + most;
  while (waitpid(pid, nullptr, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > end) {
      kill(pid, SIGKILL);
      waitpid(pid, nullptr, 0);
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

// One picture per plot. Empty, or why not.
std::string draw_plots(const fs::path& page, const fs::path& folder) {
  const fs::path browser = find_browser();
  if (browser.empty()) return "--png needs chromium; install it (apt-get install chromium)";
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return folder.string() + ": cannot make the folder: " + error.message();
  for (const std::string plot : kPlots) {
    const fs::path picture = fs::absolute(folder / (plot + ".png"));
    fs::remove(picture, error);
    const pid_t pid = start_child(
        {browser.string(), "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
         "--window-size=1100,580", "--virtual-time-budget=5000", "--screenshot=" + picture.string(),
         "file://" + fs::absolute(page).string() + "#plot=" + plot},
        "/dev/null", "/dev/null");
    if (pid < 0) return "cannot start " + browser.string() + ": " + std::strerror(errno);
    const bool ended = wait_for_child(pid, kBrowserTime);
    if (!ended) return browser.string() + " did not end while it drew " + picture.string();
    if (!fs::exists(picture, error)) return browser.string() + " made no " + picture.string();
  }
  return "";
}

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
  if (!log->finished()) {
    std::cerr << "the log is cut off: " << log->break_reason() << "\n";
  }
  if (!arguments.png.empty()) {
    error = draw_plots(arguments.output, arguments.png);
    if (!error.empty()) return fail(context, kFailed, "report", error);
  }
  if (context.json) {
    std::cout << json_text({{"report", arguments.output}, {"ticks", log->tick_count()}});
  } else {
    std::cout << "report: " << arguments.output << "\n";
    if (!arguments.png.empty()) std::cout << "plots: " << arguments.png << "\n";
  }
  return kDone;
}

}  // namespace

void add_report_command(CLI::App* app, Context* context) {
  auto* command = app->add_subcommand(
      "report", "A page that replays a log in 3-D beside its plots; one file, no network");
  auto arguments = std::make_shared<Arguments>();
  command->add_option("FILE", arguments->log, "A log of gaitd (.mcap)")
      ->required()
      ->type_name("FILE");
  command->add_option("-o,--output", arguments->output, "Page to write")
      ->type_name("FILE")
      ->capture_default_str();
  command->add_option("--png", arguments->png, "Folder for the plots as pictures; needs chromium")
      ->type_name("FOLDER");
  command->callback([context, arguments] {
    context->action = [context, arguments] { return run(*context, *arguments); };
  });
}

}  // namespace gaitd::cli
