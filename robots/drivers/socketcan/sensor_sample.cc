// SPDX-License-Identifier: Apache-2.0
#include "sensor_sample.h"

#include <algorithm>

#include "sensor_frames.h"

namespace gaitd::can {

SensorSample::Taken SensorSample::take(int part, const Frame& frame, double unit,
                                       const Moment& moment) {
  double value[3];
  const auto counter = decode_vector(frame, unit, value);
  if (!counter) return Taken::kMalformed;
  Part& own = parts_[part];
  Part& other = parts_[1 - part];
  if ((valid_ && *counter == counter_) || (own.waiting && *counter == own.counter)) {
    return Taken::kRepeated;
  }
  std::copy(value, value + 3, own.value.begin());
  own.counter = *counter;
  own.waiting = true;
  own.moment = moment;
  if (!other.waiting || other.counter != own.counter) return Taken::kPart;
  for (int i = 0; i < 2; ++i) {
    value_[i] = parts_[i].value;
    parts_[i].waiting = false;
  }
  valid_ = true;
  counter_ = *counter;
  moment_ = other.moment;  // the older one: it came first
  ++sequence_;
  return Taken::kSample;
}

}  // namespace gaitd::can
