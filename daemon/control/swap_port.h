// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>

#include "daemon/control/swap.h"

namespace gaitd::daemon {

// A swap that the control thread asks for, on behalf of a scenario.
struct SwapRequest {
  int layer = -1;
  std::int64_t tick = 0;
  double time = 0.0;           // s
  std::array<char, 256> to{};  // a variant or the path of a library
};

// Where the control thread and the one thread that loads plugins meet: wait-free rings.
class SwapPort {
 public:
  // ---- Control thread. [rt] False: the ring is full.
  bool request(const SwapRequest& request) { return requests_.push(request); }
  bool next_order(SwapOrder& order) { return orders_.pop(order); }
  bool report(const SwapReport& report) { return reports_.push(report); }
  // What holds from now on.
  void publish(SwapRight right) { right_.store(right, std::memory_order_relaxed); }

  // ---- The thread that loads.
  bool next_request(SwapRequest& request) { return requests_.pop(request); }
  bool order(const SwapOrder& order) { return orders_.push(order); }
  bool next_report(SwapReport& report) { return reports_.pop(report); }
  // To be asked before anything of a library is touched. The control thread asks again.
  SwapRight right() const { return right_.load(std::memory_order_relaxed); }

 private:
  template <class T>
  using Ring = boost::lockfree::spsc_queue<T, boost::lockfree::capacity<64>>;
  Ring<SwapRequest> requests_;
  Ring<SwapOrder> orders_;
  Ring<SwapReport> reports_;
  std::atomic<SwapRight> right_ = SwapRight::kNotStarted;
};

}  // namespace gaitd::daemon
