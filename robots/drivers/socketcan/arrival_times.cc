// SPDX-License-Identifier: Apache-2.0
#include "arrival_times.h"

#include <algorithm>

namespace gaitd::can {

ArrivalTimes::ArrivalTimes(const Clocks& clocks)
    : clocks_(clocks),
      earliest_(clocks.monotonic_ns()),
      latest_(earliest_),
      read_begin_(earliest_),
      ahead_before_(clocks.realtime_ns() - earliest_),
      ahead_now_(ahead_before_) {}

void ArrivalTimes::before_read() {
  if (emptied_) {
    earliest_ = std::max(earliest_, read_begin_);
    ahead_before_ = ahead_now_;
  }
  read_begin_ = clocks_.monotonic_ns();
}

void ArrivalTimes::after_read(bool emptied) {
  // In this order a thread that is kept waiting in between makes frames older, not younger.
  latest_ = clocks_.monotonic_ns();
  ahead_now_ = clocks_.realtime_ns() - latest_;
  emptied_ = emptied;
}

int64_t ArrivalTimes::of(int64_t stamp_ns) {
  const auto [older, younger] = std::minmax({stamp_ns - ahead_before_, stamp_ns - ahead_now_});
  const auto fits = [this](int64_t arrival) { return arrival >= earliest_ && arrival <= latest_; };
  // Apart by more than the window, only one of the two can be true; else the older one counts.
  const bool apart = younger - older > latest_ - earliest_;
  if (stamp_ns == 0) return earliest_;
  if (fits(older)) {
    earliest_ = older;
  } else if (apart && fits(younger)) {
    earliest_ = younger;
  }
  return earliest_;
}

}  // namespace gaitd::can
