// SPDX-License-Identifier: Apache-2.0
// gaitd: the walking daemon.
#include <pthread.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <thread>

#include "daemon/app/application.h"

namespace {

// SIGINT and SIGTERM are blocked in every thread and waited for in one of their own.
class StopSignals {
 public:
  StopSignals() {
    sigemptyset(&set_);
    sigaddset(&set_, SIGINT);
    sigaddset(&set_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &set_, nullptr);
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
  CLI::App app{"gaitd: real-time walking daemon for torque-controlled humanoids"};
  app.set_version_flag("--version", GAITD_VERSION " (" GAITD_BUILD ")");
  app.add_option("--config", options.config, "Configuration file (default: gaitd.yaml found)");
  app.add_option("--backend", options.backend, "simbody, socketcan or mock");
  app.add_option("--robot", options.robot, "Name of a robot or path of a robot.yaml");
  app.add_option("--scenario", options.scenario, "Scenario to play: name or file");
  app.add_option("--clock", options.clock, "realtime or lockstep")
      ->check(CLI::IsMember({"realtime", "lockstep"}));
  app.add_option("--socket", options.socket, "Unix socket for commands");
  app.add_option("--log", options.log, "Log file (MCAP)");
  app.add_option("--set", options.set, "KEY=VALUE, any configuration key; may be repeated")
      ->allow_extra_args(false);
  app.add_flag("--require-rt", options.require_rt, "Refuse to run without all real-time means");
  app.add_flag("--check-config", options.check_config,
               "Check configuration, robot and scenario, then exit");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  spdlog::set_pattern("[%H:%M:%S.%e] %^%l%$ %v");

  StopSignals signals;
  try {
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
