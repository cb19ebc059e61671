// SPDX-License-Identifier: Apache-2.0
// gaitd: the walking daemon.
#include <pthread.h>
#include <spdlog/async.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <memory>
#include <thread>

#include "daemon/app/application.h"
#include "daemon/app/check_config.h"
#include "daemon/app/command_line.h"
#include "daemon/app/terminal_log.h"

namespace {

// SIGINT, SIGTERM and SIGHUP (the terminal has gone) are blocked in every thread and waited for in
// one of their own. That somebody does not read what gaitd says is no reason to end.
sigset_t block_stop_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&set, signal);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files ends the log, not the robot
  return set;
}

// Calls a function for each of those signals, on a thread that ends with it.
class SignalThread {
 public:
  template <class Function>
  SignalThread(const sigset_t& set, Function function)
      : thread_([this, set, function] {
          const timespec poll{0, 100'000'000};
          while (!done_) {
            const int signal = sigtimedwait(&set, nullptr, &poll);
            if (signal > 0) function(signal);
          }
        }) {}
  ~SignalThread() {
    done_ = true;
    thread_.join();
  }
  SignalThread(const SignalThread&) = delete;
  SignalThread& operator=(const SignalThread&) = delete;

 private:
  std::atomic<bool> done_{false};
  std::thread thread_;
};

// Nobody who has something to say waits for the terminal or the journal: a thread of its own writes
// it, and when too much waits the oldest is dropped.
class Messages {
 public:
  Messages() {
    spdlog::init_thread_pool(kWaiting, 1);
    spdlog::set_default_logger(std::make_shared<spdlog::async_logger>(
        "gaitd", std::make_shared<spdlog::sinks::stdout_color_sink_mt>(), spdlog::thread_pool(),
        spdlog::async_overflow_policy::overrun_oldest));
    gaitd::daemon::set_terminal_log_format();
  }
  ~Messages() { spdlog::shutdown(); }  // says what waits
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;

 private:
  static constexpr std::size_t kWaiting = 1024;
};

}  // namespace

int main(int argc, char** argv) {
  gaitd::daemon::Options options;
  CLI::App app("Real-time walking daemon for torque-controlled humanoids", "gaitd");
  gaitd::usage::ValueSources values;
  gaitd::daemon::add_options(&app, &options, &values);
  const auto man = [&app] { return gaitd::usage::man_page(app, gaitd::daemon::man_text()); };
  if (gaitd::usage::answer_hidden_request(argc, argv, app, values, man)) return 0;
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  const sigset_t stop_signals = block_stop_signals();
  const Messages messages;
  try {
    gaitd::daemon::Issues issues;
    if (!options.check_file.empty() && !gaitd::daemon::choose_checked_file(&options, &issues)) {
      spdlog::error("{}", issues.error_text());
      return 1;
    }
    gaitd::daemon::Application application(options);
    // Until the backend is started no motor is on, and a disk or a library may take any time.
    std::atomic<bool> prepared{false};
    const SignalThread signals(stop_signals, [&](int signal) {
      if (!prepared) _exit(128 + signal);
      application.request_stop();
    });
    if (!application.prepare()) return 1;
    if (options.check_config) {
      spdlog::info("the configuration is in order");
      return 0;
    }
    prepared = true;
    return application.run();
  } catch (const std::exception& e) {
    spdlog::critical("{}", e.what());
    return 1;
  }
}
