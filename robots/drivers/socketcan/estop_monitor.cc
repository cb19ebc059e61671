// SPDX-License-Identifier: Apache-2.0
#include "estop_monitor.h"

#include "sensor_frames.h"

namespace gaitd::can {

bool EstopMonitor::take(const Frame& frame, const Moment& moment) {
  const bool whole = frame.length == kEstopLength;
  pressed_ = !whole || frame.data[0] != 0;
  was_pressed_ = was_pressed_ || pressed_;
  heard_ = moment;
  if (!whole) return false;
  if (counter_ && *counter_ != frame.data[1]) counted_ = moment;
  counter_ = frame.data[1];
  return true;
}

bool EstopMonitor::take_pressed() {
  const bool pressed = pressed_ || was_pressed_;
  was_pressed_ = false;
  return pressed;
}

}  // namespace gaitd::can
