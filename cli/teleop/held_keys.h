// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstddef>

#include "cli/teleop/key_decoder.h"
#include "cli/teleop/motion.h"

namespace gaitd::cli::teleop {

/// Which keys are held. A terminal tells that a key went down and, while it stays down, repeats it;
/// it never tells that it was let go. So a key counts as held for 0.7 s until its first repeat –
/// keyboards wait up to 0.66 s with it – and from then on for 0.15 s after each. A terminal repeats
/// only the key that went down last: the others run out.
class HeldKeys {
 public:
  /// A byte of a key that moves the robot came; other keys do nothing.
  void press(Key key, Time now);
  void let_go();  ///< of all
  bool any(Time now) const;
  Motion motion(Time now) const;

 private:
  static constexpr std::size_t kKeys = 6;
  static bool moves(Key key) { return static_cast<std::size_t>(key) < kKeys; }
  bool held(Key key, Time now) const { return now < keys_[static_cast<std::size_t>(key)]; }

  std::array<Time, kKeys> keys_{};  // until when each is held
};

}  // namespace gaitd::cli::teleop
