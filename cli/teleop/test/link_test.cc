// SPDX-License-Identifier: Apache-2.0
// Connections that wait for nobody, against peers that are slow, silent or gone.
#include "cli/teleop/link.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "cli/teleop/estop_line.h"
#include "cli/teleop/test/clock.h"
#include "cli/test/cli_process.h"
#include "daemon/server/listening_socket.h"

namespace gaitd::cli::teleop {
namespace {

using std::chrono::milliseconds;

class Peer : public ::testing::Test {
 protected:
  void SetUp() override { listen(); }
  ~Peer() override {
    hang_up();
    if (listener_ >= 0) close(listener_);
  }
  void listen() {
    std::string error;
    socket_.reset();  // its path goes with it
    socket_ = daemon::ListeningSocket::open(workspace_.file("s"), &error);
    ASSERT_TRUE(socket_) << error;
    listener_ = socket_->release();
  }
  Destination here() const { return {{workspace_.file("s")}, true, daemon::Role::kObserve}; }
  void accept_one() {
    hang_up();
    fd_ = accept(listener_, nullptr, nullptr);
    ASSERT_GE(fd_, 0);
  }
  void hang_up() {
    if (fd_ >= 0) close(fd_);
    fd_ = -1;
  }
  // What has come; "" if nothing has.
  std::string heard() const {
    char bytes[4096];
    const ssize_t n = recv(fd_, bytes, sizeof(bytes), MSG_DONTWAIT);
    return n > 0 ? std::string(bytes, static_cast<std::size_t>(n)) : "";
  }
  void say(const std::string& text) const {
    EXPECT_EQ(send(fd_, text.data(), text.size(), MSG_NOSIGNAL), static_cast<ssize_t>(text.size()));
  }

  Workspace workspace_;
  std::unique_ptr<daemon::ListeningSocket> socket_;
  int listener_ = -1;
  int fd_ = -1;
};

TEST_F(Peer, TakesAnswersInAnyOrderAndPieces) {
  Link link(here());
  EXPECT_EQ(link.send("status", nullptr), 0) << "not connected yet";
  ASSERT_TRUE(link.open());
  accept_one();
  const int first = link.send("status", nullptr);
  const int second = link.send("drive", {{"forward", 0.3}});
  EXPECT_NE(heard().find("\"forward\":0.3"), std::string::npos);
  EXPECT_TRUE(link.receive().empty());
  say("{\"id\":" + std::to_string(second) + ",\"error\":{\"code\":-32000,\"message\":\"no\"}}\n{");
  auto answers = link.receive();
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].id, second);
  EXPECT_EQ(std::get<daemon::RpcError>(answers[0].result).message, "no");
  say("\"id\":" + std::to_string(first) + ",\"result\":3}\n");
  answers = link.receive();
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].id, first);
}

TEST_F(Peer, KnowsWhenGaitdIsGoneOrIsNone) {
  Link link(here());
  ASSERT_TRUE(link.open());
  accept_one();
  hang_up();
  EXPECT_TRUE(link.receive().empty());
  EXPECT_FALSE(link.up());
  ASSERT_TRUE(link.open());
  accept_one();
  say("hello\n");
  link.receive();
  EXPECT_FALSE(link.up());
  EXPECT_NE(link.why_down().find("protocol"), std::string::npos);
}

TEST_F(Peer, DoesNotWaitForOneWhoReadsNothing) {
  Link link(here());
  ASSERT_TRUE(link.open());
  accept_one();
  for (int i = 0; i < 100000 && link.up(); ++i) link.send("drive", {{"forward", 0.3}});
  EXPECT_FALSE(link.up());
  EXPECT_NE(link.why_down().find("does not read"), std::string::npos);
}

TEST_F(Peer, AnEstopGoesOutAtOnceAndOnceWhenItIsConfirmed) {
  EstopLine estop(here());
  estop.tick(at(0));
  accept_one();
  estop.pull(at(10));
  EXPECT_TRUE(estop.open());
  EXPECT_NE(estop.text(), "");
  EXPECT_NE(heard().find("\"estop\""), std::string::npos);
  say("{\"id\":1,\"result\":{\"accepted\":true}}\n");
  estop.tick(at(20));
  EXPECT_FALSE(estop.open());
  EXPECT_EQ(estop.text(), "");
  estop.tick(at(5000));
  EXPECT_EQ(heard(), "");
}

TEST_F(Peer, AnEstopIsAskedForAgainUntilSomebodyAnswers) {
  EstopLine estop(here());
  estop.tick(at(0));
  accept_one();
  estop.pull(at(10));
  EXPECT_NE(heard(), "");
  estop.tick(at(200));
  EXPECT_EQ(heard(), "");
  estop.tick(at(400));  // that connection may be what hangs
  accept_one();
  EXPECT_NE(heard().find("\"estop\""), std::string::npos);
  say("{\"id\":2,\"error\":{\"code\":-32001,\"message\":\"the control loop hangs\"}}\n");
  estop.tick(at(500));
  EXPECT_TRUE(estop.open());
  EXPECT_NE(estop.text().find("the control loop hangs"), std::string::npos);
  hang_up();
  close(listener_);
  listener_ = -1;
  for (int ms = 800; ms < 1200; ms += 20) estop.tick(at(ms));
  EXPECT_TRUE(estop.open()) << "nobody is there";
  listen();
  for (int ms = 1200; ms < 1300; ms += 20) estop.tick(at(ms));
  accept_one();
  EXPECT_NE(heard().find("\"estop\""), std::string::npos);
}

TEST_F(Peer, AnEstopIsConfirmedHoweverLongTheWayIs) {
  EstopLine estop(here());
  estop.tick(at(0));
  accept_one();
  estop.pull(at(10));
  for (int ms = 20; ms < 400; ms += 20) estop.tick(at(ms));
  accept_one();
  EXPECT_NE(heard().find("\"estop\""), std::string::npos);
  for (int ms = 400; ms < 800; ms += 20) estop.tick(at(ms));
  say("{\"id\":2,\"result\":{\"accepted\":true}}\n");  // that way takes 0.4 s
  estop.tick(at(800));
  EXPECT_FALSE(estop.open());
}

TEST_F(Peer, AnEstopIsAskedForAgainAtOnceWhenItsConnectionEnds) {
  EstopLine estop(here());
  estop.tick(at(0));
  accept_one();
  estop.pull(at(10));
  for (int ms = 20; ms < 2000; ms += 20) estop.tick(at(ms));  // it has become patient
  for (int connection = 2; connection <= 3; ++connection) accept_one();
  EXPECT_NE(heard(), "");
  hang_up();
  estop.tick(at(2000));
  estop.tick(at(2040));
  accept_one();
  EXPECT_NE(heard().find("\"estop\""), std::string::npos);
  estop.tick(at(2320));
  EXPECT_EQ(heard(), "");
  estop.tick(at(2360));  // this connection is a new one: it is not patient with it yet
  accept_one();
  EXPECT_NE(heard().find("\"estop\""), std::string::npos);
}

TEST_F(Peer, AnEstopThatIsPulledAgainIsAskedForOnceMoreWhereItIs) {
  EstopLine estop(here());
  estop.tick(at(0));
  accept_one();
  estop.pull(at(10));
  EXPECT_NE(heard(), "");
  estop.pull(at(200));
  EXPECT_NE(heard().find("\"estop\""), std::string::npos);
  say("{\"id\":1,\"result\":{\"accepted\":true}}\n");
  estop.tick(at(210));
  EXPECT_FALSE(estop.open()) << "either answer confirms it";
  estop.pull(at(220));
  say("{\"id\":2,\"result\":{\"accepted\":true}}\n");
  estop.tick(at(230));
  EXPECT_TRUE(estop.open()) << "that one is of before";
  say("{\"id\":3,\"result\":{\"accepted\":true}}\n");
  estop.tick(at(240));
  EXPECT_FALSE(estop.open());
  // Whoever presses it all the time does not keep it on a connection that hangs.
  for (int ms = 300; ms < 700; ms += 20) {
    estop.pull(at(ms));
    estop.tick(at(ms));
  }
  accept_one();
  EXPECT_NE(heard().find("\"estop\""), std::string::npos);
}

}  // namespace
}  // namespace gaitd::cli::teleop
