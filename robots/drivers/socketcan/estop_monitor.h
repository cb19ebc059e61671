// SPDX-License-Identifier: Apache-2.0
// What the frames of the e-stop say, and whether it lives.
#pragma once

#include <cstdint>
#include <optional>

#include "frame.h"
#include "moment.h"

namespace gaitd::can {

enum class EstopLife { kAlive, kNeverHeard, kSilent, kStuck };

// It lives as long as its counter changes: a frame that repeats itself shows no more than that
// somebody can send. Until it has changed once it does not live.
class EstopMonitor {
 public:
  // False: the frame is of another length, which is no clear "released".
  bool take(const Frame& frame, const Moment& moment);

  // Whether it is pressed, or was since the last call: it may have been released in between.
  bool take_pressed();
  const std::optional<Moment>& heard() const { return heard_; }      // the last frame
  const std::optional<Moment>& counted() const { return counted_; }  // with another counter

 private:
  bool pressed_ = false, was_pressed_ = false;
  std::optional<uint8_t> counter_;
  std::optional<Moment> heard_, counted_;
};

}  // namespace gaitd::can
