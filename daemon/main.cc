// SPDX-License-Identifier: Apache-2.0
// gaitd: the walking daemon.
#include <pthread.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <thread>

#include "daemon/app/application.h"
#include "daemon/app/check_config.h"
#include "daemon/app/command_line.h"

namespace {

// SIGINT and SIGTERM are blocked in every thread and waited for in one of their own.
class StopSignals {
 public:
  StopSignals() {
    sigemptyset(&set_);
    sigaddset(&set_, SIGINT);
    sigaddset(&set_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &set_, nullptr);
    std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files ends the log, not the robot
  }
  template <class Function>
  void on_signal(Function function) {
    thread_ = std::thread([this, function] {
      const timespec poll{0, 100'000'000};
      while (!done_) {
        if (sigtimedwait(&set_, nullptr, &poll) > 0) function();
      }
    });
  }
  ~StopSignals() {
    done_ = true;
    if (thread_.joinable()) thread_.join();
  }

 private:
  sigset_t set_;
  std::thread thread_;
  std::atomic<bool> done_{false};
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
  spdlog::set_pattern("[%H:%M:%S.%e] %^%l%$ %v");

  StopSignals signals;
  try {
    gaitd::daemon::Issues issues;
    if (!options.check_file.empty() &&
        !gaitd::daemon::choose_checked_file(&options, &issues)) {
      spdlog::error("{}", issues.error_text());
      return 1;
    }
    gaitd::daemon::Application application(options);
    if (!application.prepare()) return 1;
    if (options.check_config) {
      spdlog::info("the configuration is in order");
      return 0;
    }
    signals.on_signal([&] { application.request_stop(); });
    return application.run();
  } catch (const std::exception& e) {
    spdlog::critical("{}", e.what());
    return 1;
  }
}
