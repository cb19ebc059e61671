// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>

namespace gaitd::daemon {

// The largest of the values within the last one to two spans of time, in constant memory.
class RecentMaximum {
 public:
  static constexpr double kSpan = 1.0;  // s

  // `time` (s) of the tick clock; one that runs backwards (a simulation that was reset) starts
  // over.
  void add(double time, double value) {
    if (time < begin_ || time >= begin_ + 2.0 * kSpan) {
      begin_ = time;
      before_ = present_ = kNone;
    } else if (time >= begin_ + kSpan) {
      begin_ += kSpan;
      before_ = present_;
      present_ = kNone;
    }
    present_ = std::max(present_, value);
  }
  double value() const { return std::max(before_, present_); }

 private:
  static constexpr double kNone = -std::numeric_limits<double>::infinity();
  double begin_ = std::numeric_limits<double>::infinity();
  double before_ = kNone;
  double present_ = kNone;
};

}  // namespace gaitd::daemon
