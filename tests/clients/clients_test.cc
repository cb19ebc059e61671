// SPDX-License-Identifier: Apache-2.0
// What clients may do to a gaitd that runs: anything, at worst to their own loss.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <memory>

#include "tests/clients/daemon_process.h"
#include "tests/storm/command_source.h"
#include "tests/storm/refusals.h"

namespace gaitd::clients {
namespace {

using daemon::RawClient;
using nlohmann::json;

constexpr const char* kStatus = R"({"jsonrpc":"2.0","id":1,"method":"status"})";

class Clients : public ::testing::Test {
 protected:
  void start(rlim_t files = 0) {
    daemon_ = std::make_unique<DaemonProcess>(
        directory_.file(), directory_.file("output"),
        std::vector<std::string>{"--clock", "realtime", "--log", directory_.file("log.mcap")},
        files);
    ASSERT_TRUE(daemon_->reaches("standing")) << daemon_->output();
  }
  // Starts another one that must refuse to, and gives what it says.
  std::string refused() {
    DaemonProcess other(directory_.file(), directory_.file("other"),
                        {"--set", "log.enabled=false"});
    EXPECT_EQ(other.end(0), 1);
    return other.output();
  }
  void expect_alive() {
    RawClient client(directory_.file());
    EXPECT_TRUE(client.ask(kStatus)["result"].is_object());
  }

  daemon::SocketDirectory directory_;
  std::unique_ptr<DaemonProcess> daemon_;
};

TEST_F(Clients, TheSocketIsOfOneDaemonAndOfItsUsersOnly) {
  ASSERT_NO_FATAL_FAILURE(start());
  struct stat info {};
  ASSERT_EQ(stat(directory_.file().c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 07777, 0660u);
  EXPECT_NE(refused().find("another gaitd listens there already"), std::string::npos);
  expect_alive();
  // Killed, it leaves a socket that nobody listens on: the next one takes its place.
  daemon_->end(SIGKILL);
  EXPECT_TRUE(std::filesystem::exists(directory_.file()));
  ASSERT_NO_FATAL_FAILURE(start());
  EXPECT_EQ(daemon_->end(SIGTERM), 0);
  EXPECT_FALSE(std::filesystem::exists(directory_.file()));
  // Something else in its place stays as it is.
  std::filesystem::create_symlink(directory_.file("log.mcap"), directory_.file());
  EXPECT_NE(refused().find("something that is no socket is there"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_symlink(directory_.file()));
  EXPECT_GT(std::filesystem::file_size(directory_.file("log.mcap")), 0u);
}

TEST_F(Clients, BeyondTheLimitAreHeardOnceOrTurnedAwayWithTheReason) {
  ASSERT_NO_FATAL_FAILURE(start());
  const int before = daemon_->descriptors();
  std::vector<std::unique_ptr<RawClient>> clients;
  for (int i = 0; i < 64; ++i) {
    clients.push_back(std::make_unique<RawClient>(directory_.file()));
    ASSERT_TRUE(clients.back()->ask(kStatus)["result"].is_object()) << i;
  }
  for (int i = 0; i < 30; ++i) {
    RawClient one_more(directory_.file());
    EXPECT_TRUE(one_more.ask(kStatus)["result"].is_object()) << i;
    EXPECT_TRUE(one_more.ended());
  }
  std::vector<std::unique_ptr<RawClient>> silent;
  for (int i = 0; i < 140; ++i) silent.push_back(std::make_unique<RawClient>(directory_.file()));
  for (const auto& client : silent) {
    const json error = client->answer()["error"];
    EXPECT_EQ(error["code"], -32002);
    EXPECT_TRUE(storm::names_its_reason(error["code"], error.value("message", "")));
    EXPECT_TRUE(client->ended());
  }
  silent.clear();
  EXPECT_TRUE(clients.front()->ask(kStatus)["result"].is_object());
  clients.clear();
  EXPECT_EQ(daemon_->descriptors(), before);
  expect_alive();
}

TEST_F(Clients, AreToldWhenDescriptorsRunOut) {
  ASSERT_NO_FATAL_FAILURE(start(40));
  std::vector<std::unique_ptr<RawClient>> clients;
  json error;
  while (clients.size() < 50 && error.is_null()) {
    clients.push_back(std::make_unique<RawClient>(directory_.file()));
    const json answer = clients.back()->ask(kStatus);
    if (!answer.contains("result")) error = answer["error"];
  }
  ASSERT_FALSE(error.is_null()) << clients.size() << " clients of 40 descriptors";
  EXPECT_EQ(error["code"], -32002);
  EXPECT_NE(error.value("message", "").find("no file descriptor left"), std::string::npos) << error;
  EXPECT_TRUE(clients.front()->ask(kStatus)["result"].is_object());
  clients.clear();
  json answer;
  for (int i = 0; i < 100 && !answer.contains("result"); ++i) {
    RawClient next(directory_.file());
    answer = next.ask(kStatus);
  }
  EXPECT_TRUE(answer.contains("result"));
}

TEST_F(Clients, ThatAreSilentOrVanishHoldNobodyUp) {
  ASSERT_NO_FATAL_FAILURE(start());
  const int before = daemon_->descriptors();
  std::vector<std::unique_ptr<RawClient>> held;
  const std::string large = R"({"jsonrpc":"2.0","id":1,"method":"mode","params":{")" +
                            std::string(200000, 'x') + "\":1}}\n";
  for (int i = 0; i < 10; ++i) {
    held.push_back(std::make_unique<RawClient>(directory_.file()));
    held.back()->send(R"({"jsonrpc":"2.0","id":1,"meth)");
    held.push_back(std::make_unique<RawClient>(directory_.file()));
    held.back()->send(std::string(200000, '['));
    RawClient gone(directory_.file());
    for (int j = 0; j < 20; ++j) gone.send(std::string(kStatus) + "\n");
    gone.send(large);
    gone.send(large.substr(0, 100000));
  }
  for (int i = 0; i < 20; ++i) expect_alive();
  held.clear();
  EXPECT_EQ(daemon_->descriptors(), before);
}

// Four clients at once for five seconds, in real time: three of them unwell.
class RandomClient {
 public:
  RandomClient(const std::string& socket, unsigned seed)
      : socket_(socket), source_(seed, {.commands = 0.05, .queries = 0.15}) {
    open();
  }

  // Sends `count` requests in a while.
  void run(int count) {
    while (count > 0) {
      const int number = source_.integer(1, 6);
      for (int i = 0; i < number; ++i) send();
      count -= number;
      const bool slow = source_.chance(0.1);
      for (int i = 0; !slow && i < 10 && take(1);) ++i;
      if (source_.chance(0.05)) vanish();
      std::this_thread::sleep_for(std::chrono::milliseconds(source_.integer(0, 60)));
    }
    client_->send("\n");
    while (take(300)) {
    }
  }
  int answers() const { return answers_; }
  int accepted() const { return accepted_; }
  const std::string& unlike() const { return unlike_; }

 private:
  void open() { client_ = std::make_unique<RawClient>(socket_); }
  void send() {
    std::string line = source_.next(storm::Scene{}).line;
    if (source_.chance(0.2)) line = source_.damaged(line);
    client_->send(line + "\n");
  }
  void vanish() {
    client_->send(source_.next(storm::Scene{}).line.substr(0, 30));
    open();
  }
  bool take(int timeout_ms) {
    const json answer = client_->answer(timeout_ms);
    for (const json& one : answer.is_array() ? answer : json::array({answer})) {
      if (!one.is_object()) continue;
      ++answers_;
      if (one.contains("result")) {
        ++accepted_;
      } else if (!storm::names_its_reason(one["error"]["code"],
                                          one["error"]["message"].get<std::string>())) {
        unlike_ = one.dump();
      }
    }
    return !answer.is_null();
  }

  std::string socket_;
  storm::CommandSource source_;
  std::unique_ptr<RawClient> client_;
  int answers_ = 0;
  int accepted_ = 0;
  std::string unlike_;
};

TEST_F(Clients, InAStormLeaveAWorkingDaemonBehind) {
  ASSERT_NO_FATAL_FAILURE(start());
  const int before = daemon_->descriptors();
  std::vector<std::unique_ptr<RandomClient>> clients;
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < 4; ++i) {
    clients.push_back(std::make_unique<RandomClient>(directory_.file(), 10 + i));
    threads.emplace_back([client = clients.back().get()] { client->run(500); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& client : clients) {
    EXPECT_GT(client->answers(), 200);
    EXPECT_GT(client->accepted(), 20);
    EXPECT_EQ(client->unlike(), "");
  }
  clients.clear();
  EXPECT_EQ(daemon_->descriptors(), before);

  const std::string state = daemon_->status().value("state", "?");
  const std::vector<std::string> states{"disarmed", "readying", "standing",
                                        "walking",  "stopping", "fault"};
  EXPECT_TRUE(std::find(states.begin(), states.end(), state) != states.end()) << state;
  // And it still does what it is told.
  RawClient client(directory_.file());
  const auto ask = [&](const std::string& method) {
    return client.ask(json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}}.dump());
  };
  EXPECT_TRUE(ask("reset").contains("result"));
  EXPECT_TRUE(ask("sim.reset").contains("result"));
  EXPECT_TRUE(daemon_->reaches("standing")) << daemon_->status();
  client.hang_up();
  EXPECT_EQ(daemon_->end(SIGTERM), 0);
  EXPECT_EQ(std::system((std::string(GAITCTL_PROGRAM " log info ") + directory_.file("log.mcap") +
                         " | grep -q 'state *finished'")
                            .c_str()),
            0);
}

}  // namespace
}  // namespace gaitd::clients
