// SPDX-License-Identifier: Apache-2.0
// Those who look on, over networks that are slow, and one who has gone.
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "cli/live/rpc_relay.h"
#include "cli/test/cli_process.h"
#include "cli/view/foxglove_client.h"
#include "cli/view/viewer.h"
#include "daemon/server/listening_socket.h"

namespace gaitd::cli {
namespace {

using std::chrono::milliseconds;

struct SlowSocket : ViewerSocket {
  void send(Message message, bool binary) override {
    (binary ? frames : texts).push_back(*message);
  }
  std::size_t waiting() const override { return queued; }
  std::size_t waiting_bytes() const override { return 0; }
  void close(const std::string&) override {}

  std::vector<std::string> frames, texts;
  std::size_t queued = 0;
};

class ViewPeers : public ::testing::Test {
 protected:
  std::shared_ptr<RpcRelay> relay(daemon::Role role) {
    return std::make_shared<RpcRelay>(role, &connector_);
  }

  Workspace workspace_;
  boost::asio::io_context io_;
  GaitdConnector connector_{&io_, workspace_.file("s")};
  std::shared_ptr<SlowSocket> socket_ = std::make_shared<SlowSocket>();
};

TEST_F(ViewPeers, FramesThatHaveNotBeenSeenHoldUpOthers) {
  const auto viewer = std::make_shared<Viewer>(relay(daemon::Role::kObserve), socket_, [](bool) {});
  const auto send_frames = [&](int count) {
    for (int i = 0; i < count; ++i) {
      std::this_thread::sleep_for(milliseconds(20));
      viewer->send_frame(message_of("frame"));
    }
  };
  send_frames(20);
  EXPECT_EQ(socket_->frames.size(), 20u) << "to one who tells nothing of what he has seen";
  viewer->on_message(R"({"type":"seen","frames":20})");
  EXPECT_EQ(socket_->texts.back(), R"({"frames":20,"type":"seen"})");
  send_frames(20);
  EXPECT_EQ(socket_->frames.size(), 36u);
  viewer->on_message(R"({"type":"seen","frames":30})");
  send_frames(1);
  EXPECT_EQ(socket_->frames.size(), 37u);
  EXPECT_EQ(socket_->texts.back(), R"({"frames":4,"type":"lost"})");
}

TEST_F(ViewPeers, WhatIsSaidOnceIsNotLeftOut) {
  const auto client =
      std::make_shared<FoxgloveClient>(relay(daemon::Role::kObserve), socket_, [] {});
  const auto channels = nlohmann::json::parse(R"([{"id":1}])");
  client->advertise(&channels, "");
  client->on_text(R"({"op":"subscribe","subscriptions":[{"id":7,"channelId":1}]})");
  socket_->queued = 1000;
  client->send_message(1, 0, "signals", false);
  EXPECT_TRUE(socket_->frames.empty());
  client->send_message(1, 0, "event", true);
  EXPECT_EQ(socket_->frames.size(), 1u);
  socket_->queued = 0;
  client->send_message(1, 0, "signals", false);
  EXPECT_EQ(socket_->frames.size(), 2u);
  EXPECT_NE(socket_->texts.back().find("1 messages were left out"), std::string::npos);
}

TEST_F(ViewPeers, AnEstopGoesOutAlthoughWhoAskedHasGone) {
  std::string error;
  const auto listening = daemon::ListeningSocket::open(workspace_.file("s"), &error);
  ASSERT_TRUE(listening) << error;
  const int listener = listening->release();
  const auto gone = relay(daemon::Role::kCommand);
  gone->call("walk", nullptr, nullptr);
  gone->call("estop", nullptr, nullptr);
  gone->end();
  pollfd waiting{listener, POLLIN, 0};  // for the thread that connects
  ASSERT_EQ(poll(&waiting, 1, 10000), 1);
  const int fd = accept(listener, nullptr, nullptr);
  ASSERT_GE(fd, 0);
  std::string heard;
  ssize_t size = -1;
  for (int tries = 0; tries < 1000 && size != 0; ++tries) {
    std::this_thread::sleep_for(milliseconds(10));
    io_.restart();
    io_.poll();
    char bytes[4096];
    size = recv(fd, bytes, sizeof(bytes), MSG_DONTWAIT);
    if (size > 0) heard.append(bytes, static_cast<std::size_t>(size));
  }
  EXPECT_NE(heard.find("\"estop\""), std::string::npos);
  EXPECT_EQ(heard.find("walk"), std::string::npos);
  EXPECT_EQ(size, 0) << "the connection stays";
  close(fd);
  close(listener);
}

}  // namespace
}  // namespace gaitd::cli
