// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <termios.h>

#include <cstddef>
#include <string>
#include <vector>

#include "cli/suspend_signal.h"

namespace gaitd::cli::teleop {

struct Line {
  std::string text;
  enum class Tone { kPlain, kGood, kBad } tone = Tone::kPlain;
};

/// The terminal of standard input and output: keys as they are pressed, unseen, and lines that stay
/// in place. A terminal that takes no bytes, by a network that hangs, holds nobody up: it misses
/// pictures. What was there before comes back when this is destroyed.
class Console {
 public:
  Console();
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  /// Whether lines can stay in place here; else they are printed one below the other.
  bool has_screen() const { return screen_; }
  std::size_t columns() const;
  std::size_t rows() const;

  /// Puts the lines on the screen, in place.
  void draw(const std::vector<Line>& lines);
  /// Prints a line below the last one.
  void print(const std::string& line);
  /// The keys that have come; does not wait.
  std::string read();
  bool ended() const { return ended_; }  ///< nobody is there any more

  /// What Ctrl-Z asks for, SuspendSignal; returns when it is over.
  void suspend();

 private:
  void enter();
  void leave();
  void put(const std::string& text);
  bool flush();

  SuspendSignal suspends_;
  bool screen_;
  bool colors_;
  int out_ = -1;  // standard output, not blocking for us alone
  bool ended_ = false;
  termios before_{};
  std::string waiting_;  // bytes that the terminal has not taken
  std::string shown_;    // the last picture
};

/// Whether somebody can press keys on standard input.
bool has_keyboard();

}  // namespace gaitd::cli::teleop
