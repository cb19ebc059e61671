// SPDX-License-Identifier: Apache-2.0
// One CAN interface through one raw socket.
#pragma once

#include <linux/can.h>
#include <sys/socket.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "mit_codec.h"

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

struct Received {
  Frame frame;
  int64_t stamp_ns = 0;  // CLOCK_REALTIME when the kernel got it; 0: not stamped
};

// send() and receive() do not block and do not allocate.
class CanBus {
 public:
  static constexpr int kBatch = 64;  // frames of one call

  // `ids`: of the frames wanted, nothing else is received but error frames. Null with `error`: no
  // such interface, not up, no CAN FD where it is asked for, or no permission.
  static std::unique_ptr<CanBus> open(const std::string& interface, bool fd,
                                      const std::vector<uint32_t>& ids, std::string* error);
  ~CanBus();
  CanBus(const CanBus&) = delete;
  CanBus& operator=(const CanBus&) = delete;

  int descriptor() const { return socket_; }
  // Frames sent, from the first on; the others are not tried again. `*down` when the interface is.
  int send(const Frame* frames, int count, bool* down);
  // Up to kBatch frames; 0: there are none left. Error frames only show in `events`.
  int receive(Received* frames, BusEvents* events);
  // Takes and forgets all that waits.
  void drain();
  // "" or what is unsuitable about the transmit queue.
  static std::string queue_advice(const std::string& interface);

 private:
  CanBus(int socket, bool fd);
  void read_control(const msghdr& header, Received* received, BusEvents* events);

  static constexpr size_t kControl = 128;
  int socket_;
  bool fd_;
  uint32_t overflow_ = 0;
  std::array<canfd_frame, kBatch> buffers_{};
  std::array<iovec, kBatch> vectors_{};
  std::array<mmsghdr, kBatch> headers_{};
  std::array<std::array<char, kControl>, kBatch> controls_{};
};

}  // namespace gaitd::can
