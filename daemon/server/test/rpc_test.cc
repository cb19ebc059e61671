// SPDX-License-Identifier: Apache-2.0
#include "daemon/server/rpc.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include <random>
#include <stdexcept>
#include <vector>

namespace gaitd::daemon {
namespace {

using nlohmann::json;

class Rpc : public ::testing::Test {
 protected:
  Rpc() {
    methods_.add("echo", [](const json& params) -> RpcResult { return params; });
    methods_.add("throw", [](const json&) -> RpcResult { throw std::runtime_error("oh"); });
    methods_.add_async("later", [this](const json&, const Caller&, Respond respond) {
      waiting_.push_back(std::move(respond));
    });
    methods_.add_snapshot("status", [] { return json{{"state", "standing"}}; });
  }
  // Everything that is sent for one line.
  std::vector<json> all(const std::string& line) {
    sent_.clear();
    handle_line(methods_, limits_, caller_, line, [this](std::string text) {
      EXPECT_EQ(text.find('\n'), std::string::npos);
      sent_.push_back(json::parse(text));
    });
    return sent_;
  }
  json one(const std::string& line) {
    const std::vector<json> sent = all(line);
    EXPECT_EQ(sent.size(), 1u) << line;
    return sent.empty() ? json() : sent[0];
  }
  int error_code(const std::string& line) { return one(line)["error"]["code"]; }

  Methods methods_;
  RpcLimits limits_;
  Caller caller_;
  std::vector<Respond> waiting_;
  std::vector<json> sent_;
};

TEST_F(Rpc, AnswersWithTheIdOfTheRequest) {
  const json answer = one(R"({"jsonrpc":"2.0","id":"a","method":"echo","params":{"x":[1]}})");
  EXPECT_EQ(answer, json::parse(R"({"jsonrpc":"2.0","id":"a","result":{"x":[1]}})"));
  EXPECT_EQ(one(R"({"jsonrpc":"2.0","id":null,"method":"echo"})")["id"], nullptr);
}

TEST_F(Rpc, RefusesWhatIsNoJson) {
  for (const char* line : {"{", "hello", "{\"a\":}", "\"\\ud800\"", "{\"a\":\"\xff\"}", "1e999",
                           "[1,2", "{} {}", "nul"}) {
    EXPECT_EQ(error_code(line), -32700) << line;
    EXPECT_TRUE(one(line)["id"].is_null());
  }
}

TEST_F(Rpc, NumbersMustBeFinite) {
  for (const char* number : {"NaN", "nan", "Infinity", "-Infinity", "1e999", "-1e999", "0x10", "+1",
                             "01", ".5", "1.", "--1"}) {
    const std::string line =
        std::string(R"({"jsonrpc":"2.0","id":1,"method":"echo","params":[)") + number + "]}";
    EXPECT_EQ(error_code(line), -32700) << number;
  }
}

TEST_F(Rpc, AKeyThatStandsTwiceIsRefused) {
  for (const char* line :
       {R"({"jsonrpc":"2.0","id":1,"method":"echo","method":"throw"})",
        R"({"jsonrpc":"2.0","id":1,"method":"echo","params":{"x":1,"y":2,"x":3}})",
        R"([{"jsonrpc":"2.0","id":1,"method":"echo","params":[{"x":[{}],"x":1}]}])"}) {
    const json error = one(line)["error"];
    EXPECT_EQ(error["code"], -32600) << line;
    EXPECT_NE(error["message"].get<std::string>().find("stands twice in one object"),
              std::string::npos);
  }
  // The same key in different objects is none.
  EXPECT_TRUE(one(R"({"jsonrpc":"2.0","id":1,"method":"echo","params":{"id":{"id":[{"id":1}]}}})")
                  .contains("result"));
}

TEST_F(Rpc, ALargeLineTakesNoLongTime) {
  // A megabyte of the smallest objects there are: a square of their number would take minutes.
  limits_.max_values = 1000000;
  std::string line = R"({"jsonrpc":"2.0","id":1,"method":"echo","params":[{})";
  for (int i = 0; i < 300000; ++i) line += ",{}";
  EXPECT_EQ(one(line + "]}")["result"].size(), 300001u);
}

TEST_F(Rpc, QuotesNoMoreOfARequestThanHelps) {
  const std::string much(100000, 'y');
  for (const std::string& line :
       {"{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"" + much + "\"}",
        "{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"echo\",\"" + much + "\":1}", "\"" + much,
        R"({"jsonrpc":"2.0","id":1,"method":"status","params":[")" + much + "\"]}",
        "{\"" + much + "\":1,\"" + much + "\":2}"}) {
    const std::string message = one(line)["error"]["message"];
    EXPECT_LT(message.size(), 600u);
    EXPECT_GT(message.size(), 20u);
  }
}

TEST_F(Rpc, RefusesWhatIsNoRequest) {
  for (const char* line :
       {"1", "\"x\"", "null", "{}", R"({"id":1,"method":"echo"})",
        R"({"jsonrpc":"1.0","id":1,"method":"echo"})", R"({"jsonrpc":"2.0","id":1})",
        R"({"jsonrpc":"2.0","id":1,"method":7})", R"({"jsonrpc":"2.0","id":[],"method":"echo"})",
        R"({"jsonrpc":"2.0","id":1,"method":"echo","params":3})",
        R"({"jsonrpc":"2.0","id":1,"method":"echo","parms":{}})"}) {
    EXPECT_EQ(error_code(line), -32600) << line;
  }
}

TEST_F(Rpc, NamesTheMethodsThereAre) {
  const json error = one(R"({"jsonrpc":"2.0","id":1,"method":"fly"})")["error"];
  EXPECT_EQ(error["code"], -32601);
  EXPECT_EQ(error["message"], "no method \"fly\"; there is: echo, later, status, throw");
}

TEST_F(Rpc, NeverAnswersANotification) {
  EXPECT_TRUE(all(R"({"jsonrpc":"2.0","method":"echo"})").empty());
  EXPECT_TRUE(all(R"({"jsonrpc":"2.0","method":"nothing"})").empty());
  EXPECT_TRUE(
      all(R"([{"jsonrpc":"2.0","method":"echo"},{"jsonrpc":"2.0","method":"throw"}])").empty());
}

TEST_F(Rpc, AnExceptionOfAHandlerBecomesAnError) {
  const json error = one(R"({"jsonrpc":"2.0","id":1,"method":"throw"})")["error"];
  EXPECT_EQ(error["code"], -32603);
  EXPECT_EQ(error["message"], "throw: internal error: oh; please report it with the request");
}

TEST_F(Rpc, SnapshotsTakeNoParams) {
  EXPECT_EQ(one(R"({"jsonrpc":"2.0","id":1,"method":"status"})")["result"]["state"], "standing");
  EXPECT_EQ(one(R"({"jsonrpc":"2.0","id":1,"method":"status","params":{}})")["result"]["state"],
            "standing");
  EXPECT_EQ(error_code(R"({"jsonrpc":"2.0","id":1,"method":"status","params":{"a":1}})"), -32602);
}

TEST_F(Rpc, ABatchIsAnsweredTogetherWhenTheLastAnswerIsThere) {
  EXPECT_TRUE(all(R"([{"jsonrpc":"2.0","id":1,"method":"later"},
                      {"jsonrpc":"2.0","id":2,"method":"echo","params":[5]},
                      {"jsonrpc":"2.0","method":"echo"}, 7])")
                  .empty());
  ASSERT_EQ(waiting_.size(), 1u);
  waiting_[0](json("done"));
  ASSERT_EQ(sent_.size(), 1u);
  ASSERT_EQ(sent_[0].size(), 3u);
  EXPECT_EQ(sent_[0][0]["result"], "done");
  EXPECT_EQ(sent_[0][1]["result"], json::array({5}));
  EXPECT_EQ(sent_[0][2]["error"]["code"], -32600);
  waiting_[0](json("again"));  // only the first answer counts
  EXPECT_EQ(sent_.size(), 1u);
}

TEST_F(Rpc, BatchesHaveBounds) {
  EXPECT_EQ(error_code("[]"), -32600);
  std::string many = "[1";
  for (int i = 0; i < limits_.max_batch; ++i) many += ",1";
  const json answer = one(many + "]");
  EXPECT_TRUE(answer.is_object());
  EXPECT_EQ(answer["error"]["code"], -32600);
}

TEST_F(Rpc, DeepNestingIsRefusedBeforeParsing) {
  const std::string deep(200000, '[');
  EXPECT_EQ(error_code(deep), -32600);
  EXPECT_EQ(error_code(R"({"jsonrpc":"2.0","id":1,"method":"echo","params":)" +
                       std::string(40, '[') + std::string(40, ']') + "}"),
            -32600);
  // Brackets in a text do not nest.
  const json answer = one(R"({"jsonrpc":"2.0","id":1,"method":"echo","params":["\")" +
                          std::string(100, '[') + R"("]})");
  EXPECT_TRUE(answer.contains("result"));
}

TEST_F(Rpc, TooManyValuesAreRefusedBeforeParsing) {
  const auto echo = [this](std::size_t values) {
    std::string line = R"({"jsonrpc":"2.0","id":1,"method":"echo","params":[[])";
    for (std::size_t i = 1; i < values; ++i) line += ",[]";
    return one(line + "]}");
  };
  EXPECT_EQ(echo(bounds::kRequestValues / 2 - 10)["result"].size(),
            bounds::kRequestValues / 2 - 10);
  const json answer = echo(bounds::kRequestValues);
  EXPECT_EQ(answer["error"]["code"], -32600);
  EXPECT_NE(answer["error"]["message"].get<std::string>().find("values, expected at most"),
            std::string::npos);
  // Commas in a text separate nothing.
  EXPECT_TRUE(one(R"({"jsonrpc":"2.0","id":1,"method":"echo","params":[")" +
                  std::string(2 * bounds::kRequestValues, ',') + R"("]})")
                  .contains("result"));
}

TEST_F(Rpc, AnswersThatAreNoUtf8AreStillJson) {
  methods_.add("bytes", [](const json&) -> RpcResult { return json("a\xff"); });
  EXPECT_TRUE(one(R"({"jsonrpc":"2.0","id":1,"method":"bytes"})")["result"].is_string());
}

TEST_F(Rpc, AnyBytesAreAnswered) {
  const std::string good = R"([{"jsonrpc":"2.0","id":1,"method":"echo","params":{"x":[1,"a"]}}])";
  std::mt19937 random(3);
  for (int i = 0; i < 20000; ++i) {
    std::string line = good;
    for (int j = 0; j < 1 + i % 4; ++j) {
      line[random() % line.size()] = static_cast<char>(random() % 256);
    }
    all(line);  // parses what is sent, and a crash or an exception fails
  }
}

TEST_F(Rpc, TheAnswersToABatchAreBoundedTogether) {
  methods_.add("large", [](const json&) -> RpcResult { return std::string(100000, 'x'); });
  json batch = json::array();
  for (int i = 0; i < 200; ++i) {
    batch.push_back({{"jsonrpc", "2.0"}, {"id", i}, {"method", i % 2 == 0 ? "large" : "status"}});
  }
  sent_.clear();
  std::size_t size = 0;
  json answers;
  handle_line(methods_, limits_, caller_, batch.dump(), [&](std::string text) {
    size = text.size();
    answers = json::parse(text);
  });
  EXPECT_LT(size, bounds::kUnreadBytes + 200 * 300);
  ASSERT_EQ(answers.size(), 200u);
  EXPECT_TRUE(answers[0].contains("result"));
  EXPECT_EQ(answers[198]["error"]["code"], -32002);
  EXPECT_EQ(answers[198]["id"], 198);
}

TEST_F(Rpc, AnIdComesBackAsItCameOrIsRefused) {
  for (const char* id :
       {"18446744073709551615", "-9223372036854775808", "\"18446744073709551616\""}) {
    const json answer =
        one(std::string(R"({"jsonrpc":"2.0","id":)") + id + R"(,"method":"status"})");
    EXPECT_EQ(answer["id"].dump(), id);
  }
  for (const char* id : {"18446744073709551616", "-9223372036854775809", "1e3", "0.5"}) {
    const json answer =
        one(std::string(R"({"jsonrpc":"2.0","id":)") + id + R"(,"method":"status"})");
    EXPECT_EQ(answer["error"]["code"], -32600) << id;
    EXPECT_TRUE(answer["id"].is_null());
  }
}

TEST_F(Rpc, AMethodNeedsItsRole) {
  for (const auto& [method, least] : method_rights()) {
    methods_.add(std::string(method), [](const json&) -> RpcResult { return "done"; });
    for (const Role role : {Role::kObserve, Role::kCommand, Role::kAdminister}) {
      caller_.role = role;
      const json answer = one(json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}}.dump());
      if (role >= least) {
        EXPECT_EQ(answer["result"], "done") << method;
        continue;
      }
      EXPECT_EQ(answer["error"]["code"], -32004) << method;
      EXPECT_EQ(answer["error"]["data"]["needed"], role_name(least));
    }
  }
  caller_.role = Role::kCommand;  // one that nobody thought of
  EXPECT_EQ(error_code(R"({"jsonrpc":"2.0","id":1,"method":"echo"})"), -32004);
}

TEST(Rights, GuardWhatProtectsTheRobot) {
  EXPECT_TRUE(is_guarded("safety.tilt_limit"));
  EXPECT_TRUE(is_guarded("swap.on_hardware"));
  EXPECT_TRUE(is_guarded("limits.torque_ratio"));
  EXPECT_TRUE(is_guarded("limits/.torque_ratio"));
  EXPECT_FALSE(is_guarded("gait.swing_duration"));
  EXPECT_FALSE(is_guarded("swapped.on_hardware"));
}

TEST(Rights, AreThoseOnTheirPage) {
  std::ifstream page(SECURITY_PAGE);
  std::map<std::string, std::string> shown;
  for (std::string line; std::getline(page, line);) {
    const std::size_t end = line.find("` | ");
    if (!line.starts_with("| `") || end == std::string::npos) continue;
    shown[line.substr(3, end - 3)] = line.substr(end + 4, line.rfind(" |") - end - 4);
  }
  std::map<std::string, std::string> real;
  for (const auto& [method, least] : method_rights()) {
    real[std::string(method)] = role_name(least);
  }
  EXPECT_EQ(shown, real);
}

TEST(EstopRequest, IsAnyObjectThatAsksForIt) {
  EXPECT_EQ(estop_request(R"({"jsonrpc":"2.0","id":7,"method":"estop"})")->id, 7);
  for (const char* line :
       {R"({"method":"estop"})", R"({"jsonrpc":"2.0","id":1,"method":"estop","params":[]})",
        R"({"jsonrpc":"2.0","id":1,"method":"estop","params":{"why":"now"},"more":[1]})",
        R"({"id":1e99,"method":"estop"})", R"({"method":"walk","method":"estop"})"}) {
    EXPECT_TRUE(estop_request(line)) << line;
  }
  EXPECT_TRUE(estop_request(R"({"method":"estop"})")->notification);
  for (const char* line : {"", "estop", "\"estop\"", R"({"method":"status","params":["estop"]})",
                           R"([{"method":"estop"}])", R"({"method":"estop")"}) {
    EXPECT_FALSE(estop_request(line)) << line;
  }
}

TEST(EstopRequest, IsFoundInABatch) {
  for (const char* line : {R"([{"method":"estop"}])", R"( [1, {"id":1,"method":"estop"}, []])",
                           R"([{"method":"status"},{"method":"estop","params":7}])"}) {
    EXPECT_TRUE(is_batch_with_estop(line)) << line;
  }
  for (const char* line :
       {"", "[", "[]", R"({"method":"estop"})", R"(["estop"])",
        R"([{"method":"status","params":["estop"]}])", R"([{"method":"estop"})"}) {
    EXPECT_FALSE(is_batch_with_estop(line)) << line;
  }
}

}  // namespace
}  // namespace gaitd::daemon
