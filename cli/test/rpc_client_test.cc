// SPDX-License-Identifier: Apache-2.0
// The client against peers that misbehave.
#include "cli/rpc_client.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <functional>
#include <thread>

#include "cli/test/cli_process.h"
#include "daemon/server/listening_socket.h"

namespace gaitd::cli {
namespace {

using daemon::RpcError;
using std::chrono::milliseconds;

class Client : public ::testing::Test {
 protected:
  // What the client makes of a peer that reads one request and then does as told.
  daemon::RpcResult call(const std::function<void(int fd)>& peer) {
    std::string error;
    auto socket = daemon::ListeningSocket::open(workspace_.file("s"), &error);
    EXPECT_TRUE(socket) << error;
    const int listener = socket->release();
    const auto client = RpcClient::connect({workspace_.file("none"), workspace_.file("s")}, &error);
    EXPECT_TRUE(client) << error;
    const int fd = accept(listener, nullptr, nullptr);
    std::thread thread([&] {
      char request[4096];
      EXPECT_GT(recv(fd, request, sizeof(request), 0), 0);
      peer(fd);
      close(fd);
    });
    const daemon::RpcResult result = client->call("status", nullptr, milliseconds(300));
    thread.join();
    close(listener);
    return result;
  }
  static std::string message(const daemon::RpcResult& result) {
    const auto* error = std::get_if<RpcError>(&result);
    return error == nullptr ? "" : error->message;
  }
  static void write_text(int fd, const std::string& text) {
    EXPECT_EQ(send(fd, text.data(), text.size(), MSG_NOSIGNAL), static_cast<ssize_t>(text.size()));
  }

  Workspace workspace_;
};

TEST_F(Client, TakesTheAnswerWithItsIdInAnyPieces) {
  const auto result = call([](int fd) {
    write_text(fd, R"({"jsonrpc":"2.0","id":99,"result":1})"
                   "\n{\"jsonrpc\":\"2.0\",");
    usleep(20000);
    write_text(fd, "\"id\":1,\"result\":{\"a\":2}}\n");
  });
  EXPECT_EQ(std::get<nlohmann::json>(result)["a"], 2);
}

TEST_F(Client, ReportsAPeerThatCloses) {
  EXPECT_NE(message(call([](int) {})).find("closed the connection"), std::string::npos);
}

TEST_F(Client, ReportsSilence) {
  EXPECT_NE(message(call([](int) { usleep(500000); })).find("did not answer in time"),
            std::string::npos);
}

TEST_F(Client, ReportsWhatIsNoAnswer) {
  for (const char* text : {"hello\n", "[]\n", "{}\n", "{\"id\":1,\"error\":3}\n"}) {
    EXPECT_NE(message(call([&](int fd) { write_text(fd, text); })), "") << text;
  }
  // An error whose members have other types is still an error.
  EXPECT_NE(message(call([](int fd) {
              write_text(fd, "{\"id\":1,\"error\":{\"code\":\"x\",\"message\":7}}\n");
            })),
            "");
}

}  // namespace
}  // namespace gaitd::cli
