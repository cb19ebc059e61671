// SPDX-License-Identifier: Apache-2.0
// The two frames of an IMU or of a foot force sensor, put together.
#pragma once

#include <array>
#include <cstdint>

#include "frame.h"
#include "moment.h"

namespace gaitd::can {

class SensorSample {
 public:
  enum class Taken {
    kPart,       // the other frame of its sample is not here yet
    kSample,     // there is a new sample
    kMalformed,  // of another length: not used
    kRepeated,   // its counter stands still: not used
  };

  // Frame `part`, 0 or 1, in units of `unit`.
  Taken take(int part, const Frame& frame, double unit, const Moment& moment);

  // The last sample: two frames with the same counter, as old as the older of them.
  bool valid() const { return valid_; }
  uint32_t sequence() const { return sequence_; }
  const Moment& moment() const { return moment_; }
  const std::array<double, 3>& value(int part) const { return value_[part]; }

 private:
  struct Part {
    std::array<double, 3> value{};
    uint16_t counter = 0;
    bool waiting = false;  // for the other frame
    Moment moment;
  };

  std::array<Part, 2> parts_{};
  std::array<std::array<double, 3>, 2> value_{};
  bool valid_ = false;
  uint16_t counter_ = 0;
  uint32_t sequence_ = 0;
  Moment moment_;
};

}  // namespace gaitd::can
