// SPDX-License-Identifier: Apache-2.0
#include "cli/teleop/pad_state.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gaitd::cli::teleop {
namespace {

constexpr double kDeadZone = 0.12;  // of the way; worn sticks rest up to there

// From -1 to 1, 0 in the dead zone, and from there without a jump.
double scaled(const PadAxis& axis, int value) {
  const double middle = 0.5 * (static_cast<double>(axis.minimum) + axis.maximum);
  const double half = 0.5 * (static_cast<double>(axis.maximum) - axis.minimum);
  if (!(half > 0.0)) return 0.0;
  const double way = std::clamp((value - middle) / half, -1.0, 1.0);
  const double rest = std::clamp(axis.flat / half, kDeadZone, 0.5);
  const double beyond = (std::abs(way) - rest) / (1.0 - rest);
  return beyond <= 0.0 ? 0.0 : std::copysign(beyond, way);
}

}  // namespace

void PadState::take(const input_event& event) {
  if (event.type == EV_SYN) {
    // What was dropped may have been the button coming up.
    if (event.code == SYN_DROPPED) let_go();
    lost_events_ = event.code == SYN_DROPPED;
    return;
  }
  if (lost_events_) return;
  if (event.type == EV_KEY) return take_button(event.code, event.value);
  if (event.type != EV_ABS) return;
  if (event.code == ABS_HAT0Y && event.value != 0) {
    pressed_.push_back(event.value < 0 ? Key::kFaster : Key::kSlower);
  }
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (event.code == axes_[i].code) values_[i] = scaled(axes_[i], event.value);
  }
}

void PadState::take_button(int code, int value) {
  if (code == BTN_TL) held_ = value != 0;
  if (value != 1) return;
  if (code == BTN_EAST) pressed_.push_back(Key::kEstop);
  if (code == BTN_SOUTH) pressed_.push_back(Key::kStop);
  if (code == BTN_START) pressed_.push_back(Key::kArm);
  if (code == BTN_SELECT) pressed_.push_back(Key::kReset);
}

void PadState::let_go() {
  held_ = false;
  values_ = {};
}

Motion PadState::motion() const {
  if (!held_) return {};
  return {-values_[1], -values_[0], -values_[2]};
}

std::vector<Key> PadState::pressed() { return std::exchange(pressed_, {}); }

}  // namespace gaitd::cli::teleop
