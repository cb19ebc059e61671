// SPDX-License-Identifier: Apache-2.0
// A status query does not touch the tick: four clients that ask a thousand times a second leave the
// time that a tick takes as it is.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <memory>

#include "tests/clients/daemon_process.h"

namespace gaitd::clients {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr int kPollers = 4;
constexpr int kWindows = 10;     // of a second, with polling and without in turn
constexpr double kMargin = 0.1;  // s, at both ends of a window

// Asks for the status every millisecond while `active`.
class Poller {
 public:
  Poller(const std::string& socket, const std::atomic<bool>* active)
      : client_(socket), active_(active), thread_([this] { run(); }) {}
  ~Poller() {
    done_ = true;
    thread_.join();
  }
  int answers() const { return answers_; }

 private:
  void run() {
    for (auto next = steady_clock::now(); !done_; std::this_thread::sleep_until(next)) {
      next = std::max(next + milliseconds(1), steady_clock::now());
      if (!*active_) continue;
      const auto answer = client_.ask(R"({"jsonrpc":"2.0","id":1,"method":"status"})");
      if (answer.is_object() && answer.contains("result")) ++answers_;
    }
  }

  daemon::RawClient client_;
  const std::atomic<bool>* active_;
  std::atomic<bool> done_{false};
  std::atomic<int> answers_{0};
  std::thread thread_;
};

struct Window {
  double begin = 0.0;  // s, tick clock
  double end = 0.0;
  bool polled = false;
};

double share(std::vector<double>* values, double part) {
  const auto at = values->begin() + static_cast<long>(part * (values->size() - 1));
  std::nth_element(values->begin(), at, values->end());
  return *at;
}

TEST(Polling, LeavesTheTickAlone) {
  const daemon::SocketDirectory directory;
  const std::string log = directory.file("log.mcap");
  DaemonProcess gaitd(directory.file(), directory.file("output"),
                      {"--clock", "realtime", "--log", log});
  ASSERT_TRUE(gaitd.reaches("standing")) << gaitd.output();
  daemon::RawClient client(directory.file());
  client.ask(R"({"jsonrpc":"2.0","id":1,"method":"walk","params":{"steps":30,"length":0.2}})");

  std::atomic<bool> active{false};
  std::vector<Window> windows;
  int answers = 0;
  {
    std::vector<std::unique_ptr<Poller>> pollers;
    for (int i = 0; i < kPollers; ++i) {
      pollers.push_back(std::make_unique<Poller>(directory.file(), &active));
    }
    for (int i = 0; i < kWindows; ++i) {
      active = i % 2 == 1;
      const double begin = gaitd.status()["time"];
      std::this_thread::sleep_for(milliseconds(1000));
      windows.push_back({begin + kMargin, gaitd.status()["time"].get<double>() - kMargin, active});
    }
    for (const auto& poller : pollers) answers += poller->answers();
  }
  EXPECT_EQ(gaitd.status()["faults"], nlohmann::json::array());
  ASSERT_EQ(gaitd.end(SIGTERM), 0);

  const std::string table = directory.file("ticks.csv");
  ASSERT_EQ(std::system((std::string(GAITCTL_PROGRAM " log export ") + log +
                         " --signals time,tick/total_us -o " + table + " >/dev/null")
                            .c_str()),
            0);
  std::vector<double> times[2];
  std::ifstream in(table);
  for (std::string line; std::getline(in, line);) {
    double time = 0.0;
    double microseconds = 0.0;
    if (std::sscanf(line.c_str(), "%lf,%lf", &time, &microseconds) != 2) continue;
    for (const Window& w : windows) {
      if (time > w.begin && time < w.end) times[w.polled].push_back(microseconds);
    }
  }
  // A slow machine simulates slower: there are fewer ticks then, and fewer answers.
  ASSERT_GT(times[0].size(), 200u);
  ASSERT_GT(times[1].size(), 200u);
  EXPECT_GT(answers, 500);
  const double median[2] = {share(&times[0], 0.5), share(&times[1], 0.5)};
  const double late[2] = {share(&times[0], 0.99), share(&times[1], 0.99)};
  std::printf("%d answers; tick without polling: median %.0f us, 99 %% %.0f us; with: %.0f, %.0f\n",
              answers, median[0], late[0], median[1], late[1]);
  // Far from what a lock would do, far above what a busy machine makes of equal ones.
  EXPECT_LT(median[1], 1.5 * median[0]);
  EXPECT_LT(late[1], 5.0 * late[0]);
}

}  // namespace
}  // namespace gaitd::clients
