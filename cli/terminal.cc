// SPDX-License-Identifier: Apache-2.0
#include "cli/terminal.h"

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <iostream>

#include "cli/escape_codes.h"
#include "cli/stop_signals.h"
#include "daemon/config/printable.h"

namespace gaitd::cli {
namespace {

using Clock = std::chrono::steady_clock;

volatile std::sig_atomic_t resized = 0;

void note_resize(int) { resized = 1; }

bool write_all(const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t n = write(STDOUT_FILENO, text.data() + done, text.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

}  // namespace

std::size_t columns_of(int descriptor) {
  winsize size{};
  if (isatty(descriptor) == 0 || ioctl(descriptor, TIOCGWINSZ, &size) != 0) return 0;
  return size.ws_col;
}

std::size_t output_columns() { return columns_of(STDOUT_FILENO); }

bool takes_escape_codes(int descriptor) {
  const char* kind = std::getenv("TERM");
  return isatty(descriptor) != 0 && kind != nullptr && *kind != '\0' &&
         std::strcmp(kind, "dumb") != 0;
}

bool shows_colors(int descriptor) {
  const char* none = std::getenv("NO_COLOR");
  const char* kind = std::getenv("TERM");
  return isatty(descriptor) != 0 && (none == nullptr || *none == '\0') && kind != nullptr &&
         std::strcmp(kind, "dumb") != 0;
}

void print_colored(bool good, const std::string& text) {
  const bool colors = shows_colors(STDOUT_FILENO);
  std::cout << std::flush;
  if (colors) write_all(good ? escape::kGreen : escape::kRed);
  std::cout << text << std::flush;
  if (colors) write_all(escape::kNoColor);
}

std::string cut_to_width(const std::string& line, std::size_t width) {
  std::size_t characters = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool begins = (static_cast<unsigned char>(line[i]) & 0xc0) != 0x80;
    if (begins && characters++ == width) return line.substr(0, i);
  }
  return line;
}

Screen::Screen() {
  keys_ = isatty(STDIN_FILENO) != 0 && tcgetattr(STDIN_FILENO, &before_) == 0;
  handle_signal(SIGWINCH, note_resize);
  enter();
}

Screen::~Screen() {
  leave();
  handle_signal(SIGWINCH, SIG_DFL);
}

void Screen::enter() {
  if (keys_) {
    termios quiet = before_;
    quiet.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    tcsetattr(STDIN_FILENO, TCSANOW, &quiet);
  }
  write_all(escape::kEnter);
}

void Screen::leave() {
  write_all(escape::kLeave);
  if (keys_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

bool Screen::draw(const std::vector<std::string>& lines) {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) return false;
  const std::size_t width = size.ws_col == 0 ? 80 : size.ws_col;
  const std::size_t height = size.ws_row == 0 ? 24 : size.ws_row;
  std::string text = escape::kHome;
  for (std::size_t i = 0; i < lines.size() && i < height; ++i) {
    if (i > 0) text += "\r\n";
    text += cut_to_width(daemon::printable(lines[i]), width) + escape::kClearLine;
  }
  if (lines.size() < height) text += std::string("\r\n") + escape::kClearBelow;
  return write_all(text);
}

Screen::Event Screen::wait(std::chrono::milliseconds time) {
  const Clock::time_point end = Clock::now() + time;
  while (!StopSignals::requested()) {
    if (SuspendSignal::requested()) {
      leave();
      SuspendSignal::suspend();
      enter();
      return Event::kResized;
    }
    if (resized != 0) {
      resized = 0;
      return Event::kResized;
    }
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    if (left <= 0) return Event::kTime;
    pollfd input{keys_ ? STDIN_FILENO : -1, POLLIN, 0};
    if (poll(&input, 1, static_cast<int>(left)) <= 0) continue;
    char key = 0;
    if (read(STDIN_FILENO, &key, 1) != 1) {
      keys_ = false;
    } else if (key == 'q' || key == 'Q') {
      return Event::kQuit;
    }
  }
  return Event::kTime;
}

}  // namespace gaitd::cli
