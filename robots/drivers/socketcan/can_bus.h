// SPDX-License-Identifier: Apache-2.0
// One CAN interface through one raw socket.
#pragma once

#include <linux/can.h>
#include <sys/socket.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "arrival_times.h"
#include "frame.h"

namespace gaitd::can {

// What the controller of the bus or the interface said.
struct BusEvents {
  bool bus_off = false;
  bool restarted = false;
  bool passive = false;
  bool active = false;  // again, after passive
  bool interface_down = false;
  uint32_t lost = 0;  // frames that the kernel dropped since the last call
};

// Frames whose identifier has the bits of `id` under `mask`.
struct IdFilter {
  uint32_t id = 0;
  uint32_t mask = 0;
  static IdFilter exactly(uint32_t id);
};

struct Received {
  Frame frame;
  int64_t stamp_ns = 0;  // CLOCK_MONOTONIC when it came, as far as it is known: never younger
};

// send() and receive() do not block and do not allocate, whatever others send.
class CanBus {
 public:
  static constexpr int kBatch = 64;  // frames of one system call
  // Frames that one receive() reads: several times what a bus can carry in a cycle. What a flood
  // leaves waits for the next call, and is lost when the socket is full.
  static constexpr int kMostFrames = 4 * kBatch;

  // `filters`: of the frames wanted, nothing else is received but error frames. Null with `error`:
  // no such interface, not up, no CAN FD where it is asked for, or no permission.
  static std::unique_ptr<CanBus> open(const std::string& interface, bool fd,
                                      const std::vector<IdFilter>& filters, std::string* error,
                                      const Clocks& clocks = Clocks::system());
  ~CanBus();
  CanBus(const CanBus&) = delete;
  CanBus& operator=(const CanBus&) = delete;

  int descriptor() const { return socket_; }
  // Frames sent, from the first on; the others are not tried again. `*down` when the interface is.
  int send(const Frame* frames, int count, bool* down);
  // Calls take(const Received&) for the frames that wait, in their order; error frames only show in
  // `events`. False: there may be more.
  template <typename Take>
  bool receive(BusEvents* events, Take&& take) {
    for (int read = 0; read < kMostFrames; read += kBatch) {
      int count = 0;
      const bool emptied = receive_batch(events, &count);
      for (int i = 0; i < count; ++i) take(std::as_const(received_[i]));
      if (emptied) return true;
    }
    return false;
  }
  // Takes and forgets what waits.
  void drain();
  // "" or what is unsuitable about the transmit queue.
  static std::string queue_advice(const std::string& interface);

 private:
  CanBus(int socket, bool fd, const Clocks& clocks);
  bool receive_batch(BusEvents* events, int* count);
  int64_t read_control(const msghdr& header, BusEvents* events);

  static constexpr size_t kControl = 128;
  int socket_;
  bool fd_;
  uint32_t overflow_ = 0;
  ArrivalTimes times_;
  std::array<Received, kBatch> received_{};
  std::array<canfd_frame, kBatch> buffers_{};
  std::array<iovec, kBatch> vectors_{};
  std::array<mmsghdr, kBatch> headers_{};
  std::array<std::array<char, kControl>, kBatch> controls_{};
};

}  // namespace gaitd::can
