// SPDX-License-Identifier: Apache-2.0
#include "cli/teleop/held_keys.h"

#include <algorithm>

namespace gaitd::cli::teleop {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kUntilFirstRepeat{700};
constexpr milliseconds kAfterRepeat{150};

Key opposite(Key key) {
  switch (key) {
    case Key::kForward:
      return Key::kBackward;
    case Key::kBackward:
      return Key::kForward;
    case Key::kLeft:
      return Key::kRight;
    case Key::kRight:
      return Key::kLeft;
    case Key::kTurnLeft:
      return Key::kTurnRight;
    default:
      return Key::kTurnLeft;
  }
}

}  // namespace

void HeldKeys::press(Key key, Time now) {
  if (!moves(key)) return;
  const bool repeat = held(key, now);
  keys_[static_cast<std::size_t>(key)] = now + (repeat ? kAfterRepeat : kUntilFirstRepeat);
  // Whoever turns round does not want to stand for the rest of the time before.
  keys_[static_cast<std::size_t>(opposite(key))] = {};
}

void HeldKeys::let_go() { keys_.fill({}); }

bool HeldKeys::any(Time now) const {
  return std::ranges::any_of(keys_, [now](Time until) { return now < until; });
}

Motion HeldKeys::motion(Time now) const {
  const auto axis = [&](Key plus, Key minus) {
    return (held(plus, now) ? 1.0 : 0.0) - (held(minus, now) ? 1.0 : 0.0);
  };
  return {axis(Key::kForward, Key::kBackward), axis(Key::kLeft, Key::kRight),
          axis(Key::kTurnLeft, Key::kTurnRight)};
}

}  // namespace gaitd::cli::teleop
