// SPDX-License-Identifier: Apache-2.0
// The client against peers that misbehave.
#include "cli/rpc_client.h"

#include <grp.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
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
    const auto client = RpcClient::connect(
        {{workspace_.file("none"), workspace_.file("s")}, true, daemon::Role::kObserve}, &error);
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

TEST_F(Client, DoesNotWaitForOneWhoLetsNobodyIn) {
  const int listener = socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  workspace_.file("s").copy(address.sun_path, sizeof(address.sun_path) - 1);
  ASSERT_EQ(bind(listener, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  ASSERT_EQ(listen(listener, 0), 0);
  std::string error;
  const Destination destination{
      {workspace_.file("s")}, true, daemon::Role::kCommand, milliseconds(100)};
  const auto waiting = RpcClient::connect(destination, &error);  // in the queue
  ASSERT_TRUE(waiting) << error;
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(RpcClient::connect(destination, &error));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, milliseconds(2000));
  EXPECT_NE(error.find("lets nobody in"), std::string::npos) << error;
  // Nor for one who reads nothing.
  const daemon::RpcResult result =
      waiting->call("status", std::string(4 << 20, 'x'), milliseconds(300));
  EXPECT_NE(message(result).find("does not read"), std::string::npos) << message(result);
  close(listener);
}

// An impostor needs another user: only root can make one here.
class Stranger : public Client {
 protected:
  // A socket at `name` on which user 65534 listens, of the given mode.
  void listen_as_stranger(const std::string& name, mode_t mode) {
    int said[2];
    ASSERT_EQ(pipe(said), 0);
    chmod(workspace_.file("").c_str(), 0777);
    child_ = fork();
    if (child_ == 0) {
      const int fd = socket(AF_UNIX, SOCK_STREAM, 0);
      sockaddr_un address{};
      address.sun_family = AF_UNIX;
      workspace_.file(name).copy(address.sun_path, sizeof(address.sun_path) - 1);
      if (setuid(65534) != 0 || bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof(address)) ||
          chmod(address.sun_path, mode) != 0 || listen(fd, 5) != 0) {
        _exit(1);
      }
      if (write(said[1], "!", 1) != 1) _exit(1);
      pause();
    }
    char byte = 0;
    ASSERT_EQ(read(said[0], &byte, 1), 1);
    close(said[0]);
    close(said[1]);
  }
  ~Stranger() override {
    if (child_ <= 0) return;
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }
  pid_t child_ = -1;
};

TEST_F(Stranger, IsOnlyBelievedWhereTheUserNamedHim) {
  if (geteuid() != 0) return;  // nobody else can be made here
  listen_as_stranger("s", 0666);
  std::string error;
  auto own = daemon::ListeningSocket::open(workspace_.file("own"), &error);
  ASSERT_TRUE(own) << error;
  const std::vector<std::string> places{workspace_.file("s"), workspace_.file("own")};
  EXPECT_FALSE(RpcClient::connect({places, false, daemon::Role::kObserve}, &error));
  EXPECT_NE(error.find("is user 65534"), std::string::npos) << error;
  EXPECT_NE(error.find("not looking further"), std::string::npos) << error;
  EXPECT_TRUE(RpcClient::connect({{places[0]}, true, daemon::Role::kObserve}, &error)) << error;
  EXPECT_TRUE(RpcClient::connect({{places[1]}, false, daemon::Role::kObserve}, &error)) << error;
}

TEST_F(Stranger, LooksNoFurtherThanWhereHeMayNotConnect) {
  if (geteuid() != 0) return;  // root may connect everywhere, and nobody else can become another
  chmod(workspace_.file("").c_str(), 0777);
  std::string error;
  auto closed = daemon::ListeningSocket::open(workspace_.file("closed"), &error);
  auto open = daemon::ListeningSocket::open(workspace_.file("open"), &error);
  ASSERT_TRUE(closed && open) << error;
  chmod(workspace_.file("open").c_str(), 0666);
  child_ = fork();
  if (child_ == 0) {
    if (setgroups(0, nullptr) != 0 || setgid(65534) != 0 || setuid(65534) != 0) _exit(1);
    const auto client = RpcClient::connect(
        {{workspace_.file("closed"), workspace_.file("open")}, false, daemon::Role::kCommand},
        &error);
    const bool told = error.find("permission denied") != std::string::npos &&
                      error.find("not looking further") != std::string::npos;
    _exit(client == nullptr && told ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child_, &status, 0), child_);
  child_ = -1;
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace gaitd::cli
