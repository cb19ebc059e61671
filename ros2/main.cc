// SPDX-License-Identifier: Apache-2.0
// gaitd-ros2: gaitd on the topics of ROS 2.
#include <spdlog/async.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <memory>

#include "daemon/usage/completion.h"
#include "ros2/bridge.h"
#include "ros2/command_line.h"

namespace {

// An e-stop does not wait for a terminal or a journal that does not read.
class Messages {
 public:
  Messages() {
    constexpr std::size_t kWaiting = 1024;
    spdlog::init_thread_pool(kWaiting, 1);
    spdlog::set_default_logger(std::make_shared<spdlog::async_logger>(
        "gaitd-ros2", std::make_shared<spdlog::sinks::stdout_color_sink_mt>(),
        spdlog::thread_pool(), spdlog::async_overflow_policy::overrun_oldest));
    spdlog::set_pattern("[%H:%M:%S.%e] %^%l%$ %v");
    spdlog::flush_on(spdlog::level::info);
  }
  ~Messages() { spdlog::shutdown(); }
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;
};

int run(const gaitd::ros2::BridgeOptions& options) {
  boost::asio::io_context io(1);
  boost::asio::signal_set signals(io, SIGINT, SIGTERM, SIGHUP);
  std::string error;
  const auto participant =
      gaitd::ros2::Participant::create(options.domain, options.localhost, &error);
  if (!participant) {
    spdlog::critical("{}", error);
    return 1;
  }
  gaitd::ros2::Bridge bridge(&io, options, participant.get());
  signals.async_wait([&](boost::system::error_code failed, int) {
    if (!failed) bridge.stop();
  });
  spdlog::info("on DDS domain {}{}{}", options.domain,
               options.localhost ? ", of this machine alone" : "",
               options.drive ? "; whoever is on it may walk the robot" : "");
  bridge.start();
  io.run();
  return 0;
}

int run_program(int argc, char** argv) {
  gaitd::ros2::BridgeOptions options;
  CLI::App app("gaitd on the topics of ROS 2", "gaitd-ros2");
  gaitd::ros2::add_options(&app, &options);
  const auto man = [&app] { return gaitd::usage::man_page(app, gaitd::ros2::man_text()); };
  if (gaitd::usage::answer_hidden_request(argc, argv, app, {}, man)) return 0;
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  std::signal(SIGPIPE, SIG_IGN);
  const Messages messages;
  try {
    return run(options);
  } catch (const std::exception& e) {
    spdlog::critical("{}", e.what());
    return 1;
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run_program(argc, argv);
  } catch (...) {
    std::fputs("gaitd-ros2: does not start: out of memory or threads?\n", stderr);
    return 1;
  }
}
