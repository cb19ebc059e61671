// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string_view>
#include <vector>

namespace gaitd::cli::teleop {

using Time = std::chrono::steady_clock::time_point;

enum class Key {
  kForward,
  kBackward,
  kLeft,
  kRight,
  kTurnLeft,
  kTurnRight,
  kStop,
  kEstop,
  kFaster,
  kSlower,
  kArm,
  kReset,
  kHelp,
  kQuit
};

/// Keys out of the bytes of a terminal. Arrows begin with the byte of Esc, and Esc is the e-stop:
/// - Esc with nothing behind it for 50 ms is an e-stop. So long the bytes of one arrow may lie
///   apart on their way; with `[` or `O` behind it, it is an arrow whose rest may come late.
/// - Esc with any other byte behind it is an e-stop at once: a hand that hits Esc may hit its
///   neighbours too.
/// - `[` or `O` that come within a second after an e-stop are the rest of an arrow that came apart
///   for too long. It is dropped: the robot must not take its letters for keys.
class KeyDecoder {
 public:
  /// What became a key with these bytes, which were read at `now`.
  std::vector<Key> take(std::string_view bytes, Time now);
  /// True if an Esc has been alone for long enough: an e-stop. Only call it when everything that
  /// had arrived by `now` was taken.
  bool lone_escape(Time now);

 private:
  enum class State { kGround, kEscape, kSequence, kLinux, kLetter };

  void take_one(unsigned char byte, Time now, std::vector<Key>* keys);
  void begin_sequence(unsigned char introducer, Time now);

  State state_ = State::kGround;
  Time since_;                 // of the state
  std::optional<Time> alone_;  // when an Esc was last found to be alone
  bool first_ = false;         // the next byte is the first of the sequence
  bool unwanted_ = false;      // the sequence means nothing
};

}  // namespace gaitd::cli::teleop
