// SPDX-License-Identifier: Apache-2.0
// On real CAN sockets: the interfaces vcan0 (FD) and vcan1 (classic) and, for bus-off, slcan on a
// pseudo terminal. The interfaces are the test's own: it takes them down and up.
#include "can_bus.h"

#include <gtest/gtest.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "slcan.h"

namespace gaitd::can {
namespace {

std::unique_ptr<CanBus> open_bus(const char* interface, bool fd, std::vector<uint32_t> ids) {
  std::string error;
  std::vector<IdFilter> filters;
  for (const uint32_t id : ids) filters.push_back(IdFilter::exactly(id));
  auto bus = CanBus::open(interface, fd, filters, &error);
  EXPECT_NE(nullptr, bus) << error;
  return bus;
}

Frame make_frame(uint32_t id, uint8_t first) {
  Frame frame;
  frame.id = id;
  frame.data[0] = first;
  return frame;
}

int send_all(CanBus* bus, const std::vector<Frame>& frames) {
  bool down = false;
  return bus->send(frames.data(), static_cast<int>(frames.size()), &down);
}

struct Result {
  std::vector<Received> frames;
  BusEvents events;
};

// What is there; waits for a frame where one is `due`, as the kernel may deliver it a little later.
Result receive_all(CanBus* bus, bool due = false) {
  Result result;
  pollfd descriptor{bus->descriptor(), POLLIN, 0};
  if (due) poll(&descriptor, 1, 5000);
  while (!bus->receive(&result.events,
                       [&](const Received& received) { result.frames.push_back(received); })) {
  }
  return result;
}

void command(const std::string& line) { ASSERT_EQ(0, std::system(line.c_str())) << line; }

TEST(CanBus, SendsABatchAndReceivesOnlyWhatItIsFor) {
  for (const bool fd : {true, false}) {
    const char* interface = fd ? "vcan0" : "vcan1";
    auto sender = open_bus(interface, fd, {});
    auto receiver = open_bus(interface, fd, {0x11, 0x13});
    EXPECT_EQ(
        3, send_all(sender.get(), {make_frame(0x11, 1), make_frame(0x12, 2), make_frame(0x13, 3)}));
    const Result got = receive_all(receiver.get(), true);
    ASSERT_EQ(2u, got.frames.size());
    EXPECT_EQ(0x11u, got.frames[0].frame.id);
    EXPECT_EQ(3, got.frames[1].frame.data[0]);
    EXPECT_GT(got.frames[0].stamp_ns, 0);
    EXPECT_GE(got.frames[1].stamp_ns, got.frames[0].stamp_ns);
    EXPECT_TRUE(receive_all(sender.get()).frames.empty());
  }
}

TEST(CanBus, AcceptsClassicFramesOnAnFdBus) {
  auto classic = open_bus("vcan0", false, {});
  auto receiver = open_bus("vcan0", true, {0x21});
  EXPECT_EQ(1, send_all(classic.get(), {make_frame(0x21, 9)}));
  const Result got = receive_all(receiver.get(), true);
  ASSERT_EQ(1u, got.frames.size());
  EXPECT_EQ(9, got.frames[0].frame.data[0]);
}

TEST(CanBus, CountsWhatTheReceiverDropped) {
  auto sender = open_bus("vcan1", false, {});
  auto receiver = open_bus("vcan1", false, {0x31});
  int sent = 0;
  for (int i = 0; i < 40; ++i) {
    sent += send_all(sender.get(), std::vector<Frame>(CanBus::kBatch, make_frame(0x31, 0)));
  }
  Result got = receive_all(receiver.get());
  sent += send_all(sender.get(), {make_frame(0x31, 1)});  // carries the count
  const Result last = receive_all(receiver.get(), true);
  const size_t received = got.frames.size() + last.frames.size();
  EXPECT_LT(received, static_cast<size_t>(sent));
  EXPECT_EQ(static_cast<size_t>(sent), received + got.events.lost + last.events.lost);
}

TEST(CanBus, ReadsNoMoreAtOnceThanABusCanCarryAndTheRestTheNextTime) {
  auto sender = open_bus("vcan1", false, {});
  auto receiver = open_bus("vcan1", false, {0x32});
  const int most = CanBus::kMostFrames;
  const int room = 1 << 22;
  ASSERT_EQ(0, setsockopt(receiver->descriptor(), SOL_SOCKET, SO_RCVBUFFORCE, &room, sizeof(room)));
  for (int i = 0; i < 2 * most / CanBus::kBatch; ++i) {
    send_all(sender.get(), std::vector<Frame>(CanBus::kBatch, make_frame(0x32, 0)));
  }
  BusEvents events;
  int got = 0;
  const auto count = [&](const Received&) { ++got; };
  EXPECT_FALSE(receiver->receive(&events, count));
  EXPECT_EQ(most, got);
  receiver->receive(&events, count);
  EXPECT_EQ(2 * most, got);
}

TEST(CanBus, ShowsTheLengthOfFramesThatAreTooLong) {
  auto receiver = open_bus("vcan0", true, {0x33});
  const int socket = ::socket(PF_CAN, SOCK_RAW, CAN_RAW);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex("vcan0"));
  ASSERT_EQ(0, bind(socket, reinterpret_cast<sockaddr*>(&address), sizeof(address)));
  const int on = 1;
  ASSERT_EQ(0, setsockopt(socket, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof(on)));
  canfd_frame frame{};
  frame.can_id = 0x33;
  frame.len = 64;
  std::fill(std::begin(frame.data), std::end(frame.data), uint8_t{7});
  ASSERT_EQ(ssize_t{sizeof(frame)}, ::write(socket, &frame, sizeof(frame)));
  close(socket);
  const Result got = receive_all(receiver.get(), true);
  ASSERT_EQ(1u, got.frames.size());
  EXPECT_EQ(64, got.frames[0].frame.length);
  EXPECT_EQ(7, got.frames[0].frame.data[7]);
}

TEST(CanBus, SaysWhenTheInterfaceIsDownAndWorksAgainWhenItIsUp) {
  auto sender = open_bus("vcan1", false, {});
  auto receiver = open_bus("vcan1", false, {0x41});
  command("ip link set vcan1 down");
  bool down = false;
  const Frame frame = make_frame(0x41, 1);
  EXPECT_TRUE(receive_all(sender.get()).events.interface_down);
  EXPECT_EQ(0, sender->send(&frame, 1, &down));
  EXPECT_TRUE(down);
  EXPECT_TRUE(receive_all(receiver.get()).events.interface_down);
  std::string error;
  EXPECT_EQ(nullptr, CanBus::open("vcan1", false, {}, &error));
  EXPECT_NE(std::string::npos, error.find("not up")) << error;
  command("ip link set vcan1 up");
  EXPECT_EQ(1, sender->send(&frame, 1, &down));
  EXPECT_FALSE(down);
  EXPECT_EQ(1u, receive_all(receiver.get(), true).frames.size());
}

TEST(CanBus, RefusesFdOnAClassicInterfaceAndNamesThatAreNotThere) {
  std::string error;
  EXPECT_EQ(nullptr, CanBus::open("vcan1", true, {}, &error));
  EXPECT_NE(std::string::npos, error.find("no CAN FD")) << error;
  EXPECT_EQ(nullptr, CanBus::open("can99", false, {}, &error));
  EXPECT_NE(std::string::npos, error.find("no such interface")) << error;
}

TEST(CanBus, SeesBusOffOfAnSlcanAdapter) {
  Slcan wire;
  auto bus = open_bus(wire.name().c_str(), false, {0x51});
  ASSERT_NE(nullptr, bus);
  wire.send(make_frame(0x51, 0xAB));
  EXPECT_EQ(1u, receive_all(bus.get(), true).frames.size());
  wire.bus_off();
  const Result off = receive_all(bus.get());
  EXPECT_TRUE(off.events.bus_off);
  EXPECT_TRUE(off.frames.empty());
}

}  // namespace
}  // namespace gaitd::can
