// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <linux/input.h>

#include <array>
#include <cstddef>
#include <vector>

#include "cli/teleop/key_decoder.h"
#include "cli/teleop/motion.h"

namespace gaitd::cli::teleop {

/// How an axis of a gamepad reports itself, as in `struct input_absinfo`.
struct PadAxis {
  int code = 0;  ///< ABS_X, ...
  int minimum = -32768;
  int maximum = 32767;
  int flat = 0;  ///< from the middle, within which it reports rest
};

/// The axes that drive. Up and left are the minimum of each.
struct PadAxes {
  PadAxis forward{ABS_Y};
  PadAxis lateral{ABS_X};
  PadAxis turn{ABS_RX};
};

/// What the hands do on a gamepad, from its events. The robot moves only while the dead man's
/// button (LB) is held; it counts from the moment it is seen to be pressed, not if it was down
/// before.
class PadState {
 public:
  explicit PadState(const PadAxes& axes) : axes_{axes.lateral, axes.forward, axes.turn} {}

  void take(const input_event& event);
  /// The device is gone, or has lost events: nothing is held.
  void let_go();
  bool held() const { return held_; }
  Motion motion() const;  ///< still unless held()
  /// Buttons that went down since the last call: B e-stop, A stop, Start arms, Back resets, cross
  /// up and down the speed.
  std::vector<Key> pressed();

 private:
  void take_button(int code, int value);

  std::array<PadAxis, 3> axes_;     // lateral, forward, turn
  std::array<double, 3> values_{};  // -1 to 1, as the device has them
  bool held_ = false;
  bool lost_events_ = false;  // until the end of the report
  std::vector<Key> pressed_;
};

}  // namespace gaitd::cli::teleop
