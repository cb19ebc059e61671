// SPDX-License-Identifier: Apache-2.0
// When the frames of a socket came, on the monotonic clock. The kernel stamps them with the wall
// clock, which may be set or slewed at any time.
#pragma once

#include <cstdint>

#include "clocks.h"

namespace gaitd::can {

// A frame that is read now came after the socket was last seen empty. Within that window its stamp
// says when, by what the wall clock was ahead of the monotonic one at either end of the window; a
// stamp that fits neither says nothing, and the frame is as old as it can be. So no step of the
// wall clock makes a frame younger than it is, or older than the window.
class ArrivalTimes {
 public:
  // The socket is new.
  explicit ArrivalTimes(const Clocks& clocks);

  // Around every call that reads frames; `emptied`: it left none in the socket.
  void before_read();
  void after_read(bool emptied);

  // ns of CLOCK_MONOTONIC, of a frame of the last read, in their order; never before that of the
  // frame before it, nor after the end of the read. `stamp_ns`: of CLOCK_REALTIME, 0: there is
  // none.
  int64_t of(int64_t stamp_ns);

 private:
  const Clocks& clocks_;
  int64_t earliest_;  // start of the window
  int64_t latest_;    // its end
  int64_t read_begin_;
  int64_t ahead_before_, ahead_now_;  // at the ends of the window
  bool emptied_ = true;
};

}  // namespace gaitd::can
