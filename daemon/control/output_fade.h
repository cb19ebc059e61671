// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "daemon/control/output_blend.h"

namespace gaitd::daemon {

// The way of an output from one layer to another, over a time. [rt]
template <class Output>
class OutputFade {
 public:
  // Over `time` s from what follow() gives, tick by tick, or else from `from`.
  void begin(const Output& from, double time) {
    from_ = from;
    left_ = time_ = time;
  }
  void end() { left_ = 0.0; }
  bool active() const { return left_ > 0.0; }
  void follow(const Output& from) { from_ = from; }
  // One tick of `dt` s on the way.
  void apply(double dt, Output& out) {
    if (!active()) return;
    left_ -= dt;
    cross_fade(from_, 1.0 - std::max(0.0, left_) / std::max(time_, dt), out);
  }

 private:
  Output from_{};
  double time_ = 0.0;  // s
  double left_ = 0.0;  // s
};

}  // namespace gaitd::daemon
