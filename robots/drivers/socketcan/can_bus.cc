// SPDX-License-Identifier: Apache-2.0
#include "can_bus.h"

#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <linux/net_tstamp.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace gaitd::can {
namespace {

bool is_down(int error) {
  return error == ENETDOWN || error == ENODEV || error == ENXIO || error == ENETUNREACH;
}

template <typename T>
bool set(int socket, int level, int option, const T& value) {
  return setsockopt(socket, level, option, &value, sizeof(value)) == 0;
}

void read_error_frame(const canfd_frame& frame, BusEvents* events) {
  const uint32_t error = frame.can_id & CAN_ERR_MASK;
  if ((error & CAN_ERR_BUSOFF) != 0) events->bus_off = true;
  if ((error & CAN_ERR_RESTARTED) != 0) events->restarted = true;
  if ((error & CAN_ERR_CRTL) == 0) return;
  if ((frame.data[1] & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0) {
    events->passive = true;
  }
  if ((frame.data[1] & CAN_ERR_CRTL_ACTIVE) != 0) events->active = true;
}

}  // namespace

static_assert(kExtended == CAN_EFF_FLAG);

IdFilter IdFilter::exactly(uint32_t id) {
  return {id, CAN_EFF_FLAG | ((id & kExtended) != 0 ? CAN_EFF_MASK : CAN_SFF_MASK)};
}

std::unique_ptr<CanBus> CanBus::open(const std::string& interface, bool fd,
                                     const std::vector<IdFilter>& filters, std::string* error,
                                     const Clocks& clocks) {
  const auto fail = [&](const char* what, const char* advice) {
    *error = interface + ": " + what + ": " + std::strerror(errno) + "; " + advice;
    return nullptr;
  };
  const int socket = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
  if (socket < 0) return fail("no CAN socket", "load the kernel module can-raw");
  std::unique_ptr<CanBus> bus(new CanBus(socket, fd, clocks));

  ifreq request{};
  std::strncpy(request.ifr_name, interface.c_str(), IFNAMSIZ - 1);
  if (ioctl(socket, SIOCGIFINDEX, &request) < 0) {
    return fail("no such interface", "see `ip link show type can`");
  }
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = request.ifr_ifindex;
  if (ioctl(socket, SIOCGIFFLAGS, &request) < 0 || (request.ifr_flags & IFF_UP) == 0) {
    errno = ENETDOWN;
    return fail("not up", "bring it up (networkd, or `ip link set up`)");
  }
  if (fd && (ioctl(socket, SIOCGIFMTU, &request) < 0 || request.ifr_mtu < int{CANFD_MTU})) {
    errno = EINVAL;
    return fail("no CAN FD", "configure the interface for FD, or remove data_bitrate");
  }

  std::vector<can_filter> wanted;
  for (const IdFilter& filter : filters) wanted.push_back({filter.id, filter.mask | CAN_RTR_FLAG});
  const can_err_mask_t errors = CAN_ERR_MASK;
  const int stamping = SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE;
  const bool ready = setsockopt(socket, SOL_CAN_RAW, CAN_RAW_FILTER, wanted.data(),
                                static_cast<socklen_t>(wanted.size() * sizeof(can_filter))) == 0 &&
                     set(socket, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, errors) &&
                     set(socket, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, 1) &&
                     set(socket, SOL_SOCKET, SO_TIMESTAMPING, stamping) &&
                     set(socket, SOL_SOCKET, SO_RXQ_OVFL, 1) &&
                     bind(socket, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0;
  if (!ready) return fail("the socket cannot be set up", "check the kernel's CAN support");
  return bus;
}

CanBus::CanBus(int socket, bool fd, const Clocks& clocks)
    : socket_(socket), fd_(fd), times_(clocks) {
  for (int i = 0; i < kBatch; ++i) vectors_[i] = {&buffers_[i], sizeof(canfd_frame)};
}

CanBus::~CanBus() { close(socket_); }

int CanBus::send(const Frame* frames, int count, bool* down) {
  *down = false;
  count = std::min(count, kBatch);
  for (int i = 0; i < count; ++i) {
    canfd_frame& out = buffers_[i];
    std::memset(&out, 0, sizeof(can_frame));
    out.can_id = frames[i].id;
    out.len = frames[i].length;
    out.flags = fd_ ? CANFD_BRS : 0;
    std::memcpy(out.data, frames[i].data.data(), frames[i].length);
    vectors_[i].iov_len = fd_ ? sizeof(canfd_frame) : sizeof(can_frame);
    headers_[i] = {};
    headers_[i].msg_hdr.msg_iov = &vectors_[i];
    headers_[i].msg_hdr.msg_iovlen = 1;
  }
  const int sent = count == 0 ? 0 : sendmmsg(socket_, headers_.data(), count, MSG_DONTWAIT);
  if (sent < 0) *down = is_down(errno);
  return std::max(sent, 0);
}

// True: nothing is left.
bool CanBus::receive_batch(BusEvents* events, int* count) {
  for (int i = 0; i < kBatch; ++i) {
    vectors_[i].iov_len = sizeof(canfd_frame);
    headers_[i] = {};
    headers_[i].msg_hdr.msg_iov = &vectors_[i];
    headers_[i].msg_hdr.msg_iovlen = 1;
    headers_[i].msg_hdr.msg_control = controls_[i].data();
    headers_[i].msg_hdr.msg_controllen = kControl;
  }
  times_.before_read();
  const int got = recvmmsg(socket_, headers_.data(), kBatch, MSG_DONTWAIT, nullptr);
  const bool failed = got < 0 && errno != EAGAIN && errno != EWOULDBLOCK;
  if (failed && is_down(errno)) events->interface_down = true;
  const bool emptied = got < kBatch && !failed;
  times_.after_read(emptied);
  for (int i = 0; i < got; ++i) {
    Received& received = received_[*count];
    received.stamp_ns = times_.of(read_control(headers_[i].msg_hdr, events));
    const canfd_frame& in = buffers_[i];
    if ((in.can_id & CAN_ERR_FLAG) != 0) {
      read_error_frame(in, events);
      continue;
    }
    const bool extended = (in.can_id & CAN_EFF_FLAG) != 0;
    received.frame.id =
        extended ? in.can_id & (CAN_EFF_FLAG | CAN_EFF_MASK) : in.can_id & CAN_SFF_MASK;
    received.frame.length = in.len;
    received.frame.data = {};
    std::memcpy(received.frame.data.data(), in.data,
                std::min<size_t>(in.len, received.frame.data.size()));
    ++*count;
  }
  return emptied;
}

// The stamp of the frame, 0 if there is none.
int64_t CanBus::read_control(const msghdr& header, BusEvents* events) {
  auto* all = const_cast<msghdr*>(&header);
  int64_t stamp_ns = 0;
  for (cmsghdr* c = CMSG_FIRSTHDR(all); c != nullptr; c = CMSG_NXTHDR(all, c)) {
    if (c->cmsg_level != SOL_SOCKET) continue;
    if (c->cmsg_type == SCM_TIMESTAMPING) {
      timespec stamp;
      std::memcpy(&stamp, CMSG_DATA(c), sizeof(stamp));
      stamp_ns = int64_t{1000000000} * stamp.tv_sec + stamp.tv_nsec;
    } else if (c->cmsg_type == SO_RXQ_OVFL) {
      uint32_t total = 0;
      std::memcpy(&total, CMSG_DATA(c), sizeof(total));
      events->lost += total - overflow_;
      overflow_ = total;
    }
  }
  return stamp_ns;
}

void CanBus::drain() {
  BusEvents events;
  // A bus that is flooded never ends.
  constexpr int kMostCalls = 64;
  for (int i = 0; i < kMostCalls && !receive(&events, [](const Received&) {}); ++i) {
  }
}

std::string CanBus::queue_advice(const std::string& interface) {
  std::ifstream file("/sys/class/net/" + interface + "/tx_queue_len");
  int length = 0;
  constexpr int kLongest = 64;
  if (!(file >> length) || length <= kLongest) return "";
  return interface + ": txqueuelen " + std::to_string(length) +
         ", expected 16..32: a long queue sends old commands after the bus comes back";
}

}  // namespace gaitd::can
