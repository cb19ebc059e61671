// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "daemon/control/swap.h"

namespace gaitd::daemon {

// The swap that a layer is in, or was in last, and what is to be told of it. [rt]
class SwapJournal {
 public:
  // What the reports say of the swap; a copy of it goes with each step.
  SwapReport& swap() { return swap_; }
  const SwapReport& swap() const { return swap_; }

  // A step of the swap; `retired` is no longer needed.
  void tell(SwapStep step, LoadedLayer* retired = nullptr) { tell(swap_, step, retired); }
  // A step of another one, that does not even begin.
  void tell(SwapReport report, SwapStep step, LoadedLayer* retired) {
    report.step = step;
    report.retired = retired;
    reports_[count_++] = report;
  }

  // What was told, in order, each once.
  bool take(SwapReport* report) {
    if (count_ == 0) return false;
    *report = reports_[0];
    std::copy(reports_.begin() + 1, reports_.begin() + count_--, reports_.begin());
    return true;
  }

 private:
  SwapReport swap_;
  std::array<SwapReport, 4> reports_;  // a tick makes at most three
  int count_ = 0;
};

}  // namespace gaitd::daemon
