// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <termios.h>

#include <chrono>
#include <string>
#include <vector>

#include "cli/suspend_signal.h"

namespace gaitd::cli {

/// A full screen on the terminal of standard output: the alternate screen without cursor, and keys
/// that are not echoed. What was there before comes back when it is destroyed.
class Screen {
 public:
  Screen();
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// Puts lines on the screen in one write, over what is there: no flicker. Lines longer than the
  /// window and lines below its end are left out. False if the terminal is gone.
  bool draw(const std::vector<std::string>& lines);

  enum class Event { kTime, kQuit, kResized };
  /// Waits that long, for `q`, or for a new size of the window; Ctrl-Z leaves and comes back.
  /// Signals of StopSignals end it early as kTime.
  Event wait(std::chrono::milliseconds time);

 private:
  void enter();
  void leave();

  SuspendSignal suspends_;
  bool keys_ = false;  // standard input is a terminal too
  termios before_{};
};

/// Of the terminal that `descriptor` is; 0 if it is none, or does not know.
std::size_t columns_of(int descriptor);
/// Of that of standard output.
std::size_t output_columns();

/// Whether `descriptor` is a terminal that takes escape codes.
bool takes_escape_codes(int descriptor);

/// Colours only for a person who sees them: `descriptor` is a terminal that has some, and NO_COLOR
/// is not set (https://no-color.org).
bool shows_colors(int descriptor);

/// `text` on standard output, green or red where that shows colours. Foreign text may be in it:
/// only the colours pass PlainOutput by.
void print_colored(bool good, const std::string& text);

/// At most `width` characters of a line of UTF-8.
std::string cut_to_width(const std::string& line, std::size_t width);

}  // namespace gaitd::cli
