// SPDX-License-Identifier: Apache-2.0
// What docs/protocol.md says is what a gaitd does: every example is sent to a private one and its
// answer compared in shape with the one on the page, and the page has every method there is.
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "cli/rpc_client.h"
#include "cli/test/cli_process.h"

namespace gaitd {
namespace {

using cli::RpcClient;
using daemon::RpcError;
using nlohmann::json;

struct Example {  // NOLINT(bugprone-exception-escape): json moves without exceptions
  int line = 0;
  json request;
  json answer;
};

// The blocks of the page in ```json: a request and its answer, one after the other.
std::vector<Example> read_examples() {
  std::ifstream page(PROTOCOL_PAGE);
  std::vector<Example> examples;
  std::string block;
  bool inside = false;
  int number = 0;
  for (std::string line; std::getline(page, line);) {
    ++number;
    if (!inside) {
      inside = line == "```json";
      block.clear();
    } else if (line != "```") {
      block += line + "\n";
    } else {
      inside = false;
      std::istringstream text(block);
      Example example;
      example.line = number;
      try {
        text >> example.request >> example.answer;
      } catch (const json::exception& e) {
        ADD_FAILURE() << "the example before line " << number << ": " << e.what();
        continue;
      }
      examples.push_back(example);
    }
  }
  return examples;
}

// Headings of the third level: the methods.
std::set<std::string> documented_methods() {
  std::ifstream page(PROTOCOL_PAGE);
  std::set<std::string> methods;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("### ")) methods.insert(line.substr(4));
  }
  return methods;
}

// What differs in keys and types; "" if nothing does. A null on either side fits everything, a list
// fits if each item has the shape of one on the page.
std::string difference(const json& page, const json& real, const std::string& path) {
  if (page.is_null() || real.is_null()) return "";
  if (page.is_number() && real.is_number()) return "";
  if (page.type() != real.type()) {
    return path + ": " + page.type_name() + " on the page, " + real.type_name() + " in truth";
  }
  if (page.is_object()) {
    for (const auto& [key, value] : page.items()) {
      const std::string at = (path + "/").append(key);
      if (!real.contains(key)) return at + ": only on the page";
      std::string found = difference(value, real[key], at);
      if (!found.empty()) return found;
    }
    for (const auto& [key, value] : real.items()) {
      if (!page.contains(key)) return (path + "/").append(key) + ": not on the page";
    }
  }
  if (page.is_array() && !page.empty()) {
    for (const json& item : real) {
      std::string found;
      for (const json& sample : page) {
        found = difference(sample, item, path + "[]");
        if (found.empty()) break;
      }
      if (!found.empty()) return found;
    }
  }
  return "";
}

// A gaitd of the test's own.
class Protocol : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string socket = workspace_.file("gaitd.sock");
    const std::string output = workspace_.file("gaitd.txt");
    pid_ = fork();
    if (pid_ == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (std::freopen(output.c_str(), "w", stdout) == nullptr || dup2(1, 2) < 0) _exit(127);
      const std::string log = workspace_.file("log.mcap");
      execl(GAITD, GAITD, "--socket", socket.c_str(), "--log", log.c_str(), nullptr);
      _exit(127);
    }
    std::string error;
    for (int i = 0; i < 600 && !client_; ++i) {
      client_ = RpcClient::connect({{socket}, true, daemon::Role::kAdminister}, &error);
      ASSERT_EQ(waitpid(pid_, nullptr, WNOHANG), 0) << workspace_.read("gaitd.txt");
      if (!client_) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    ASSERT_TRUE(client_) << error;
    wait_until_standing();
  }
  void TearDown() override {
    kill(pid_, SIGTERM);
    int status = 0;
    waitpid(pid_, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << workspace_.read("gaitd.txt");
  }

  void wait_until_standing() {
    json status;
    for (int i = 0; i < 1200; ++i) {
      status = std::get<json>(client_->call("status", nullptr));
      if (status["state"] == "standing") return;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    FAIL() << "not standing: " << status;
  }
  void wait_until_tared() {
    for (int i = 0; i < 400; ++i) {
      if (!std::get<json>(client_->call("status", nullptr))["external"].is_null()) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    FAIL() << "not tared";
  }
  // As on the page: {"result": ...} or {"error": {code, message, data}}.
  json answer_to(const json& request) {
    const auto result =
        client_->call(request.at("method").get<std::string>(), request.value("params", json()));
    const auto* error = std::get_if<RpcError>(&result);
    if (error == nullptr) return {{"result", std::get<json>(result)}};
    json out = {{"error", {{"code", error->code}, {"message", error->message}}}};
    if (!error->data.is_null()) out["error"]["data"] = error->data;
    return out;
  }

  cli::Workspace workspace_;
  pid_t pid_ = -1;
  std::unique_ptr<RpcClient> client_;
};

TEST_F(Protocol, EveryExampleIsAnsweredAsThePageSays) {
  const std::vector<Example> examples = read_examples();
  ASSERT_GE(examples.size(), 15u);
  for (const Example& example : examples) {
    SCOPED_TRACE("docs/protocol.md, the example before line " + std::to_string(example.line));
    json expected = example.answer;
    EXPECT_EQ(expected["id"], example.request["id"]);
    expected.erase("jsonrpc");
    expected.erase("id");
    // Where one drives, another cannot renew, and the first one can end it.
    const json params = example.request.value("params", json::object());
    if (params.contains("end") || params.value("renew", false)) {
      const json first = {{"forward", 0.1}, {"session", 7}};
      ASSERT_TRUE(std::holds_alternative<json>(client_->call("drive", first)));
    }
    if (example.request["method"] == "joint.test" && expected.contains("result")) {
      ASSERT_TRUE(std::holds_alternative<json>(client_->call("disarm", nullptr)));
    }
    const std::string method = example.request["method"];
    if (method == "payload.estimate" || method.starts_with("handhold.")) wait_until_tared();
    if (method == "handhold.release") {
      const json hold = {{"hand", "right"}, {"normal", {0, 1, 0}}, {"force", 80}};
      ASSERT_TRUE(std::holds_alternative<json>(client_->call("handhold.take", hold)));
    }
    const json real = answer_to(example.request);
    EXPECT_EQ(difference(expected, real, ""), "") << real;
    if (expected.contains("error") && real.contains("error")) {
      EXPECT_EQ(real["error"]["code"], expected["error"]["code"]);
    }
    // Whatever it did, the next example finds the robot standing.
    if (!expected.contains("result") || !expected["result"].contains("accepted")) continue;
    ASSERT_TRUE(std::holds_alternative<json>(client_->call("sim.reset", nullptr)));
    wait_until_standing();
  }
}

TEST_F(Protocol, ThePageHasEveryMethodWithAnExample) {
  const auto result = client_->call("no.such.method", nullptr);
  const auto* error = std::get_if<RpcError>(&result);
  ASSERT_NE(error, nullptr);
  const std::string marker = "there is: ";
  const std::size_t list = error->message.find(marker);
  ASSERT_NE(list, std::string::npos) << error->message;
  std::set<std::string> methods;
  std::istringstream names(error->message.substr(list + marker.size()));
  for (std::string name; std::getline(names >> std::ws, name, ',');) methods.insert(name);
  EXPECT_EQ(documented_methods(), methods);
  std::set<std::string> with_rights;
  for (const auto& [method, least] : daemon::method_rights()) with_rights.emplace(method);
  EXPECT_EQ(with_rights, methods) << "methods with a row in the table of rights";

  std::set<std::string> shown;
  for (const Example& example : read_examples()) {
    if (example.answer.contains("result")) shown.insert(example.request["method"]);
  }
  EXPECT_EQ(shown, methods) << "methods with an example that succeeds";
}

TEST_F(Protocol, AStatusAfterACommandShowsItsTick) {
  for (int i = 0; i < 20; ++i) {
    const json reply = std::get<json>(client_->call(i % 2 == 0 ? "pause" : "resume", nullptr));
    const json status = std::get<json>(client_->call("status", nullptr));
    EXPECT_GE(status["tick"], reply["tick"]);
    EXPECT_EQ(status["paused"], i % 2 == 0);
  }
}

}  // namespace
}  // namespace gaitd
