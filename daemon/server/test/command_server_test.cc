// SPDX-License-Identifier: Apache-2.0
#include "daemon/server/command_server.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <thread>

#include "daemon/server/stream.h"
#include "daemon/server/test/raw_client.h"

namespace gaitd::daemon {
namespace {

using nlohmann::json;

constexpr const char* kSlow = R"({"jsonrpc":"2.0","id":8,"method":"plugin.list"})";
constexpr const char* kStatus = R"({"jsonrpc":"2.0","id":1,"method":"status"})";
constexpr const char* kArm = R"({"jsonrpc":"2.0","id":2,"method":"arm"})";

// A server whose control thread accepts everything, at tick 42, while `answering_`.
class Server : public ::testing::Test {
 protected:
  Server() { options_.socket_path = directory_.file(); }
  ~Server() override {
    server_.reset();
    stop_ = true;
    if (control_.joinable()) control_.join();
  }
  void start(CommandBridge::Clock::duration timeout = std::chrono::milliseconds(200)) {
    bridge_ = std::make_unique<CommandBridge>(timeout);
    control_ = std::thread([this] {
      const auto command = std::make_unique<Command>();
      for (std::int64_t tick = 0; !stop_; ++tick) {
        if (answering_) estop_.take(tick);
        while (answering_ && bridge_->try_pop(*command)) {
          ++taken_;
          estops_known_ = command->estops;
          bridge_->push({command->request, true, 42, {}});
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
    Methods methods;
    methods.add_snapshot("status", [] { return json{{"state", "standing"}}; });
    methods.add("plugin.list", [this](const json&) -> RpcResult {  // takes long
      begun_ = true;
      while (hanging_ && !stop_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      return "done";
    });
    methods.add("large", [](const json&) -> RpcResult { return std::string(100000, 'x'); });
    methods.add_async("stream", [this](const json&, const Caller& caller, const Respond& respond) {
      stream_ = caller.stream;
      respond("here it comes");
    });
    add_command_methods(&methods, bridge_.get(),
                        [](const std::string&, const json&) -> std::variant<Command, RpcError> {
                          return Command{};
                        });
    std::string error;
    server_ = CommandServer::start(options_, std::move(methods), bridge_.get(), &estop_, &error);
    ASSERT_TRUE(server_) << error;
  }
  void expect_alive() {
    RawClient client(directory_.file());
    EXPECT_EQ(client.ask(kStatus)["result"]["state"], "standing");
  }

  // Until the thread of the requests is busy with a request that takes as long as hanging_.
  void wait_for_hang() {
    while (!begun_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  // Sends more slow requests than may wait; how many.
  int keep_busy(RawClient* client) {
    const int lines = static_cast<int>(bounds::kLinesWaiting) + 20;
    for (int i = 0; i < lines; ++i) client->send(std::string(kSlow) + "\n");
    wait_for_hang();
    return lines;
  }

  SocketDirectory directory_;
  ServerOptions options_;
  EstopFlag estop_;
  std::shared_ptr<Stream> stream_;
  std::atomic<bool> hanging_{false};
  std::atomic<bool> begun_{false};
  std::unique_ptr<CommandBridge> bridge_;
  std::atomic<bool> answering_{true};
  std::atomic<bool> stop_{false};
  std::atomic<int> taken_{0};
  std::atomic<std::uint64_t> estops_known_{0};  // by the last command
  std::thread control_;
  std::unique_ptr<CommandServer> server_;
};

TEST_F(Server, AnswersQueriesAndCommands) {
  start();
  EXPECT_EQ(server_->socket_path(), directory_.file());
  RawClient client(directory_.file());
  EXPECT_EQ(client.ask(kStatus)["result"]["state"], "standing");
  EXPECT_EQ(client.ask(kArm)["result"],
            (json{{"accepted", true}, {"tick", 42}, {"note", nullptr}}));
}

TEST_F(Server, AStreamIsCountedAndGoesWithItsClient) {
  start();
  {
    RawClient client(directory_.file());
    EXPECT_EQ(client.ask(R"({"jsonrpc":"2.0","id":1,"method":"stream"})")["result"],
              "here it comes");
    ASSERT_TRUE(stream_);
    EXPECT_TRUE(stream_->open());
    // More than a client may leave unread of its answers: it is the sender who stops here.
    const int lines = 40;
    for (int i = 0; i < lines; ++i) stream_->send(std::string(100'000, 'x'));
    EXPECT_GT(stream_->unread(), 1'000'000u);
    EXPECT_EQ(client.line()->size(), 100'000u);
    for (int i = 1; i < lines; ++i) ASSERT_TRUE(client.line());
    EXPECT_EQ(client.ask(kStatus)["result"]["state"], "standing");
    EXPECT_EQ(stream_->unread(), 0u);
  }
  for (int i = 0; i < 5000 && stream_->open(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_FALSE(stream_->open());
  stream_->send("to nobody");
  expect_alive();
  EXPECT_EQ(stream_->unread(), 0u);
  stream_.reset();
}

TEST_F(Server, ServesSeveralClientsEachItsOwnAnswers) {
  start();
  std::vector<std::thread> threads;
  std::atomic<int> right{0};
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&, i] {
      RawClient client(directory_.file());
      for (int j = 0; j < 20; ++j) {
        const int id = 100 * i + j;
        const json answer =
            client.ask(json{{"jsonrpc", "2.0"}, {"id", id}, {"method", "arm"}}.dump());
        if (answer["id"] == id && answer["result"]["accepted"] == true) ++right;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(right, 160);
}

TEST_F(Server, TakesLinesInPiecesAndSeveralAtOnce) {
  start();
  RawClient client(directory_.file());
  for (const char c : std::string(kStatus)) client.send(std::string(1, c));
  EXPECT_FALSE(client.line(50));
  client.send("\r\n\n");
  EXPECT_TRUE(client.answer()["result"].is_object());
  client.send(std::string(kStatus) + "\n" + kStatus + "\n" + kStatus + "\n");
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(client.answer()["result"].is_object());
}

TEST_F(Server, AnswersAfterTheClientEndedItsSide) {
  start();
  RawClient client(directory_.file());
  client.send(std::string(kArm) + "\n" + R"({"jsonrpc":)");
  client.end_sending();
  json first = client.answer();
  json second = client.answer();
  if (first.contains("error")) std::swap(first, second);
  EXPECT_EQ(first["result"]["tick"], 42);
  EXPECT_EQ(second["error"]["code"], -32700);
  EXPECT_TRUE(client.ended());
}

TEST_F(Server, MalformedLinesCostOnlyAnError) {
  start();
  RawClient client(directory_.file());
  EXPECT_EQ(client.ask("{")["error"]["code"], -32700);
  EXPECT_EQ(client.ask(std::string(5000, '['))["error"]["code"], -32600);
  EXPECT_EQ(client.ask(std::string("\0\0", 2))["error"]["code"], -32700);
  EXPECT_TRUE(client.ask(kStatus)["result"].is_object());
}

TEST_F(Server, ALineOverTheLimitEndsTheConnection) {
  start();
  const std::string padding(options_.max_request - std::string(kStatus).size(), ' ');
  RawClient fits(directory_.file());
  EXPECT_TRUE(fits.ask(kStatus + padding)["result"].is_object());
  for (const char* end : {" \n", " "}) {
    RawClient client(directory_.file());
    client.send(kStatus + padding + end);
    EXPECT_EQ(client.answer()["error"]["code"], -32600);
    EXPECT_TRUE(client.ended());
  }
  expect_alive();
}

TEST_F(Server, HalfALineIsNotWaitedForForEver) {
  options_.max_line_time = std::chrono::milliseconds(100);
  start();
  RawClient silent(directory_.file());
  RawClient half(directory_.file());
  RawClient dripping(directory_.file());
  half.send(R"({"jsonrpc":"2.0",)");
  // A line that never ends is no better for a byte now and then.
  for (int i = 0; i < 200 && dripping.send(" "); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  for (RawClient* client : {&half, &dripping}) {
    const json error = client->answer()["error"];
    EXPECT_EQ(error["code"], -32600);
    EXPECT_NE(error["message"].get<std::string>().find("no newline within 100 ms"),
              std::string::npos);
    EXPECT_TRUE(client->ended());
  }
  EXPECT_TRUE(silent.ask(kStatus)["result"].is_object());
}

TEST_F(Server, TheTimeOfALineBeginsWithItsFirstByte) {
  options_.max_line_time = std::chrono::milliseconds(400);
  start();
  RawClient client(directory_.file());
  const std::string line = std::string(kStatus) + "\n";
  // Longer than the limit altogether, every line within it.
  client.send(line.substr(0, 5));
  for (int i = 0; i < 6; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    client.send(line.substr(5) + line.substr(0, 5));
    EXPECT_TRUE(client.answer()["result"].is_object());
  }
}

TEST_F(Server, AClientThatDoesNotReadIsDropped) {
  options_.max_unread_output = 1 << 20;
  start();
  RawClient slow(directory_.file());
  const std::string request = R"({"jsonrpc":"2.0","id":1,"method":"large"})"
                              "\n";
  int sent = 0;
  while (sent < 2000 && slow.send(request)) ++sent;
  // Without reading, however long the answers take: empty lines ask for nothing.
  bool open = true;
  for (int i = 0; i < 3000 && open; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    open = slow.send("\n");
  }
  EXPECT_FALSE(open);
  EXPECT_TRUE(slow.ended());
  expect_alive();
}

int descriptors() {
  int count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    ++count;
  }
  return count;
}

// They have given their places back, and would keep descriptors and memory.
TEST_F(Server, ClientsThatEndTheirSideAndDoNotReadAreDropped) {
  options_.max_line_time = std::chrono::milliseconds(100);
  start();
  const int before = descriptors();
  std::vector<std::unique_ptr<RawClient>> clients;
  for (int i = 0; i < 5; ++i) {
    clients.push_back(std::make_unique<RawClient>(directory_.file()));
    for (int k = 0; k < 8; ++k) {
      clients.back()->send(R"({"jsonrpc":"2.0","id":1,"method":"large"})"
                           "\n");
    }
    clients.back()->end_sending();
  }
  const int own = static_cast<int>(clients.size());
  bool gone = false;
  for (int i = 0; i < 300 && !gone; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    gone = i > 20 && descriptors() <= before + own;
  }
  EXPECT_TRUE(gone);
  expect_alive();
}

TEST_F(Server, ClientsThatVanishLeaveNothingBehind) {
  answering_ = false;
  start();
  for (int i = 0; i < 30; ++i) {
    RawClient client(directory_.file());
    client.send(std::string(kArm) + "\n" + kStatus + "\n{\"half");
  }
  answering_ = true;
  for (int i = 0; i < 200 && taken_ < 30; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(taken_, 30);
  expect_alive();
}

TEST_F(Server, ANotificationIsCarriedOutSilently) {
  start();
  RawClient client(directory_.file());
  client.send("{\"jsonrpc\":\"2.0\",\"method\":\"stop\"}\n");
  EXPECT_EQ(client.ask(kStatus)["result"]["state"], "standing");
  for (int i = 0; i < 200 && taken_ < 1; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(taken_, 1);
  EXPECT_FALSE(client.line(20));
}

TEST_F(Server, SaysThatTheControlThreadDoesNotAnswer) {
  answering_ = false;
  start();
  RawClient client(directory_.file());
  const json error = client.ask(kArm)["error"];
  EXPECT_EQ(error["code"], -32001);
  EXPECT_NE(error["message"].get<std::string>().find("did not answer within 200 ms"),
            std::string::npos);
}

TEST_F(Server, TurnsClientsAwayBeyondTheLimit) {
  options_.max_clients = 2;
  start();
  RawClient first(directory_.file());
  auto second = std::make_unique<RawClient>(directory_.file());
  EXPECT_TRUE(first.ask(kStatus)["result"].is_object());
  EXPECT_TRUE(second->ask(kStatus)["result"].is_object());
  RawClient third(directory_.file());
  EXPECT_EQ(third.answer()["error"]["code"], -32002);
  EXPECT_TRUE(third.ended());
  second.reset();
  json answer;
  for (int i = 0; i < 100 && !answer.contains("result"); ++i) {
    RawClient next(directory_.file());
    answer = next.ask(kStatus);
  }
  EXPECT_TRUE(answer.contains("result"));
}

TEST_F(Server, EndsPromptlyAndTellsThoseWhoWait) {
  answering_ = false;
  start(std::chrono::hours(1));
  RawClient waiting(directory_.file());
  RawClient idle(directory_.file());
  waiting.send(std::string(kArm) + "\n");
  EXPECT_TRUE(idle.ask(kStatus)["result"].is_object());
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const auto begin = std::chrono::steady_clock::now();
  server_.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
  EXPECT_EQ(waiting.answer()["error"]["code"], -32003);
  EXPECT_TRUE(waiting.ended());
  EXPECT_TRUE(idle.ended());
  EXPECT_FALSE(std::filesystem::exists(directory_.file()));
}

TEST_F(Server, ASecondServerOnTheSameSocketIsRefused) {
  start();
  std::string error;
  EXPECT_FALSE(CommandServer::start(options_, Methods(), nullptr, &estop_, &error));
  EXPECT_NE(error.find("another gaitd"), std::string::npos) << error;
  expect_alive();
}

constexpr const char* kEstop = R"({"jsonrpc":"2.0","id":9,"method":"estop"})";

TEST_F(Server, AnEstopWaitsForNoOtherRequest) {
  hanging_ = true;
  start();
  RawClient busy(directory_.file());
  for (int i = 0; i < 100; ++i) busy.send(std::string(kSlow) + "\n");
  wait_for_hang();
  for (int i = 0; i < 20; ++i) {
    RawClient other(directory_.file());
    const json answer = other.ask(kEstop);
    EXPECT_EQ(answer["id"], 9);
    EXPECT_EQ(answer["result"]["accepted"], true) << answer;
    EXPECT_GE(answer["result"]["tick"], answer["result"]["read_at_tick"]);
    EXPECT_LE(answer["result"]["tick"].get<int>(), answer["result"]["read_at_tick"].get<int>() + 1);
  }
  hanging_ = false;
  for (int i = 0; i < 100; ++i) EXPECT_EQ(busy.answer()["result"], "done");
}

TEST_F(Server, AnEstopPassesWhatItsOwnClientHasWaiting) {
  hanging_ = true;
  start();
  RawClient client(directory_.file());
  const int lines = keep_busy(&client);
  client.send(std::string(kEstop) + "\n");
  EXPECT_EQ(client.answer()["id"], 9);
  client.send("[" + std::string(kStatus) + "]\n");
  hanging_ = false;
  for (int i = 0; i < lines; ++i) EXPECT_EQ(client.answer()["result"], "done");
  EXPECT_TRUE(client.answer().is_array());
}

// A reset that waited is older than an e-stop that passed it.
TEST_F(Server, WhatWaitedDoesNotKnowOfTheEstopsSince) {
  hanging_ = true;
  start();
  RawClient client(directory_.file());
  const int lines = keep_busy(&client);
  client.send(std::string(kArm) + "\n" + kEstop + "\n");
  EXPECT_EQ(client.answer()["id"], 9);
  hanging_ = false;
  for (int i = 0; i < lines; ++i) EXPECT_EQ(client.answer()["result"], "done");
  EXPECT_EQ(client.answer()["result"]["tick"], 42);
  EXPECT_EQ(estops_known_, 0u);
  EXPECT_EQ(client.ask(kArm)["result"]["tick"], 42);
  EXPECT_EQ(estops_known_, 1u);
}

TEST_F(Server, AnEstopInABatchIsRaisedWhenItIsRead) {
  hanging_ = true;
  start();
  RawClient client(directory_.file());
  client.send(std::string(kSlow) + "\n");
  wait_for_hang();
  client.send("[" + std::string(kStatus) + "," + kEstop + "]\n");
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  while (estop_.asked() == 0 && std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(estop_.asked(), 1u);
  hanging_ = false;
  EXPECT_EQ(client.answer()["result"], "done");
  const json answers = client.answer();
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_EQ(answers[1]["result"]["accepted"], true);
  EXPECT_EQ(estop_.asked(), 1u);  // its turn does not stop the robot once more
  // Even one that is refused as a whole.
  client.send("[" + std::string(kEstop) + R"(,{"a":1,"a":2}])" + "\n");
  EXPECT_EQ(client.answer()["error"]["code"], -32600);
  EXPECT_EQ(estop_.asked(), 2u);
}

TEST_F(Server, AnEstopWithoutANewlineIsTakenWhenItsClientEnds) {
  start();
  RawClient client(directory_.file());
  client.send(kEstop);
  client.end_sending();
  EXPECT_EQ(client.answer()["result"]["accepted"], true);
  EXPECT_TRUE(client.ended());
  // Its sender waits for no answer.
  RawClient(directory_.file()).send(kEstop);
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  while (estop_.asked() < 2 && std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(estop_.asked(), 2u);
}

TEST_F(Server, WhatWaitsIsCarriedOutThoughItsClientHasGone) {
  hanging_ = true;
  start();
  {
    RawClient client(directory_.file());
    client.send(std::string(kSlow) + "\n");
    wait_for_hang();
    for (std::size_t i = 0; i < 3 * bounds::kLinesWaiting; ++i) {
      client.send(std::string(kArm) + "\n");
    }
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  hanging_ = false;
  for (int i = 0; i < 200 && taken_ < static_cast<int>(3 * bounds::kLinesWaiting); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(taken_, static_cast<int>(3 * bounds::kLinesWaiting));
  expect_alive();
}

TEST_F(Server, HoldsSoManyBytesOfAClientAndNoMore) {
  hanging_ = true;
  start();
  RawClient client(directory_.file());
  client.send(std::string(kSlow) + "\n");
  wait_for_hang();
  const std::string line = kStatus + std::string(100000, ' ') + "\n";
  std::atomic<int> sent{0};
  std::thread sender([&] {
    for (; sent < 40 && client.send(line); ++sent) {
    }
  });
  for (int last = -1; last != sent; std::this_thread::sleep_for(std::chrono::milliseconds(100))) {
    last = sent;
  }
  EXPECT_LT(sent, 12);  // two for the worker, three for the session, and what the socket holds
  hanging_ = false;
  EXPECT_EQ(client.answer()["result"], "done");
  for (int i = 0; i < 40; ++i) EXPECT_TRUE(client.answer()["result"].is_object()) << i;
  sender.join();
}

TEST_F(Server, AnEstopIsNeverRefusedForItsForm) {
  start();
  RawClient client(directory_.file());
  for (const char* line : {R"({"jsonrpc":"2.0","id":1,"method":"estop","params":[]})",
                           R"({"jsonrpc":"2.0","id":1,"method":"estop","params":{"a":1}})",
                           R"({"id":1,"method":"estop"})",
                           R"({"jsonrpc":"2.0","id":1,"method":"estop","method":"estop"})"}) {
    EXPECT_EQ(client.ask(line)["result"]["accepted"], true) << line;
  }
  // Within a batch, and in a line too long for the lane of its own.
  EXPECT_EQ(client.ask("[" + std::string(kEstop) + "]")[0]["result"]["accepted"], true);
  EXPECT_EQ(client.ask(kEstop + std::string(2 * bounds::kEstopBytes, ' '))["result"]["accepted"],
            true);
}

TEST_F(Server, AnEstopThatNobodyActsOnSaysSo) {
  answering_ = false;
  start();
  RawClient client(directory_.file());
  const json error = client.ask(kEstop)["error"];
  EXPECT_EQ(error["code"], -32001);
  EXPECT_NE(error["message"].get<std::string>().find("use the e-stop of the robot"),
            std::string::npos);
  answering_ = true;  // it is not forgotten
  while (!estop_.acted_on(1)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST_F(Server, WhoFillsAllPlacesKeepsNobodyFromOneRequest) {
  options_.max_clients = 4;
  start();
  std::vector<std::unique_ptr<RawClient>> idle;
  for (int i = 0; i < 20; ++i) idle.push_back(std::make_unique<RawClient>(directory_.file()));
  for (int i = 0; i < 10; ++i) {
    RawClient client(directory_.file());
    EXPECT_EQ(client.ask(kEstop)["result"]["accepted"], true);
    EXPECT_TRUE(client.ended());
    RawClient another(directory_.file());
    EXPECT_EQ(another.ask(kStatus)["result"]["state"], "standing");
    EXPECT_TRUE(another.ended());
  }
  EXPECT_EQ(idle[0]->ask(kStatus)["result"]["state"], "standing");
  EXPECT_EQ(idle[0]->ask(kStatus)["result"]["state"], "standing");
}

TEST_F(Server, EverySocketHasItsRole) {
  start();
  RawClient own(directory_.file());
  EXPECT_EQ(own.ask(kSlow)["result"], "done");
  EXPECT_EQ(own.ask(R"({"jsonrpc":"2.0","id":1,"method":"large"})")["error"], nullptr);
  RawClient observer(directory_.file("gaitd-observe.sock"));
  EXPECT_EQ(observer.ask(kStatus)["result"]["state"], "standing");
  EXPECT_EQ(observer.ask(kArm)["error"]["code"], -32004);
  EXPECT_EQ(observer.ask(kEstop)["result"]["accepted"], true);
  RawClient administrator(directory_.file("gaitd-admin.sock"));
  EXPECT_EQ(administrator.ask(kArm)["result"]["accepted"], true);
  EXPECT_EQ(administrator.ask(R"({"jsonrpc":"2.0","id":1,"method":"large"})")["error"], nullptr);
  server_.reset();
  for (const char* name : {"gaitd.sock", "gaitd-observe.sock", "gaitd-admin.sock"}) {
    EXPECT_FALSE(std::filesystem::exists(directory_.file(name))) << name;
  }
}

TEST_F(Server, AFloodOfLinesIsAnsweredLineByLine) {
  start();
  RawClient flood(directory_.file());
  std::thread sender([&] {
    for (int i = 0; i < 5000; ++i) flood.send(std::string(kStatus) + "\n");
  });
  RawClient quiet(directory_.file());
  for (int i = 0; i < 20; ++i) EXPECT_EQ(quiet.ask(kStatus)["result"]["state"], "standing");
  for (int i = 0; i < 5000; ++i) ASSERT_TRUE(flood.answer()["result"].is_object()) << i;
  sender.join();
}

}  // namespace
}  // namespace gaitd::daemon
