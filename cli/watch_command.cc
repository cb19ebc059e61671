// SPDX-License-Identifier: Apache-2.0
#include "cli/watch_command.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cli/failure.h"
#include "cli/rpc_client.h"
#include "cli/status_view.h"
#include "cli/stop_signals.h"
#include "cli/terminal.h"
#include "daemon/server/socket_path.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr milliseconds kWatchRound{200};       // until keys and signals are looked at
constexpr milliseconds kWatchSilent{1000};     // then the user is told
constexpr milliseconds kWatchPatience{10000};  // with a gaitd that hangs
constexpr const char* kHowToEnd = "q or Ctrl-C ends it";

struct WatchOptions {
  double interval = 0.2;  // s
  bool once = false;
  bool reconnect = false;
};

// Where the refreshes go.
class Output {
 public:
  Output(bool json, bool once) : json_(json) {
    if (!json && !once && takes_escape_codes(STDOUT_FILENO)) {
      screen_.emplace();
    }
  }

  // False if nobody takes them any more.
  bool show(const json& status) {
    if (screen_) {
      lines_ = status_screen(status);
      lines_.emplace_back();
      lines_.emplace_back(kHowToEnd);
      return screen_->draw(lines_);
    }
    std::cout << (json_ ? status.dump(-1, ' ', false, json::error_handler_t::replace)
                        : status_line(status))
              << std::endl;
    return static_cast<bool>(std::cout);
  }
  // Above the last status, if there was one, which is old. Not between the lines of a script.
  bool show_silence(milliseconds silent) {
    if (!screen_) return true;
    const std::string words =
        "gaitd has not answered for " + std::to_string(silent.count() / 1000) + " s";
    if (lines_.empty()) return screen_->draw({words, "", kHowToEnd});
    std::vector<std::string> lines = {words + ": what stands below is old", ""};
    lines.insert(lines.end(), lines_.begin(), lines_.end());
    return screen_->draw(lines);
  }
  // While there is no daemon. Not between the lines of a script.
  bool show_waiting(const std::string& why) {
    return !screen_ || screen_->draw({"waiting for gaitd", "", why});
  }
  // False if the user is done.
  bool wait(milliseconds time) {
    if (screen_) return screen_->wait(time) != Screen::Event::kQuit && !StopSignals::requested();
    for (; time.count() > 0 && !StopSignals::requested(); time -= milliseconds(20)) {
      std::this_thread::sleep_for(std::min(time, milliseconds(20)));
    }
    return !StopSignals::requested();
  }
  void close() { screen_.reset(); }

 private:
  bool json_;
  std::optional<Screen> screen_;
  std::vector<std::string> lines_;  // on it
};

// Of the daemon, or what went wrong; `patient` with one that hangs. Nothing if the user is done.
std::optional<daemon::RpcResult> ask_status(RpcClient* client, bool patient, Output* output) {
  if (auto problem = client->ask("status", nullptr)) return *std::move(problem);
  const Clock::time_point asked = Clock::now();
  for (;;) {
    if (auto answer = client->answer(Clock::now() + kWatchRound)) return answer;
    const auto silent = std::chrono::duration_cast<milliseconds>(Clock::now() - asked);
    if (!patient && silent > kWatchPatience) return no_answer();
    if (silent > kWatchSilent && !output->show_silence(silent)) return std::nullopt;
    if (!output->wait(milliseconds(20))) return std::nullopt;
  }
}

int watch(const Context& context, const WatchOptions& options) {
  const StopSignals signals;
  std::signal(SIGPIPE, SIG_IGN);  // a reader that has enough is no failure
  const milliseconds interval(std::lround(1e3 * options.interval));
  const Destination destination = Destination::of(context.socket, daemon::Role::kObserve);
  std::string error;
  std::unique_ptr<RpcClient> client = RpcClient::connect(destination, &error);
  if (!client && !options.reconnect) return fail(context, kNoDaemon, "watch", error);
  Output output(context.json, options.once);
  do {
    if (!client) client = RpcClient::connect(destination, &error);
    if (!client) {
      if (!output.show_waiting(error)) return kDone;
      continue;
    }
    const auto result = ask_status(client.get(), options.reconnect, &output);
    if (!result) return kDone;
    if (const json* status = std::get_if<json>(&*result)) {
      if (!output.show(*status) || options.once) return kDone;
      continue;
    }
    if (StopSignals::requested()) return kDone;
    const auto& problem = std::get<daemon::RpcError>(*result);
    const bool gone =
        problem.code == kConnectionLost || problem.code == daemon::rpc_code::kStopping;
    if (gone && options.reconnect) {
      client.reset();
      continue;
    }
    output.close();
    if (gone) return fail(context, kNoDaemon, "watch", "gaitd has ended");
    return fail(context, "watch", "status", problem);
  } while (output.wait(interval));
  return kDone;
}

}  // namespace

void add_watch_command(CLI::App* app, Context* context) {
  auto* command = app->add_subcommand(
      "watch", "Show the status live: a table on a terminal, else a line each time");
  command->footer("Exit code 0 when you end it, 3 when gaitd ends.");
  auto options = std::make_shared<WatchOptions>();
  command->add_flag("--once", options->once, "Show it once, on one line, and end");
  command->add_option("--interval", options->interval, "Time between refreshes, s, 0.02 to 3600")
      ->check(CLI::Range(0.02, 3600.0))
      ->type_name("S")
      ->capture_default_str();
  command->add_flag(
      "--reconnect", options->reconnect,
      "Wait for a daemon if there is none or it hangs, and for the next when it ends");
  command->callback([context, options] {
    context->action = [context, options] { return watch(*context, *options); };
  });
}

}  // namespace gaitd::cli
