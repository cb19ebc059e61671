// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/pace.h"

#include <cmath>

namespace gaitd::daemon {

Pace::Pace(double period, OverrunPolicy policy, double longest_run)
    : period_(std::llround(1e9 * period)),
      longest_run_(std::llround(1e9 * longest_run)),
      policy_(policy) {}

Pace::Next Pace::after_tick(std::int64_t now) {
  due_ += period_;
  const std::int64_t late = now - due_;
  if (late <= 0) {
    behind_ = 0;
    return {due_};
  }
  if (behind_ == 0) first_missed_ = due_;
  behind_ = now - first_missed_;
  const bool catch_up = policy_ == OverrunPolicy::kCatchUp && late < longest_run_;
  if (!catch_up) due_ += late / period_ * period_ + period_;
  return {due_, true, policy_ == OverrunPolicy::kStop && behind_ > longest_run_};
}

}  // namespace gaitd::daemon
