// SPDX-License-Identifier: Apache-2.0
#include "cli/teleop/console.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>

#include "cli/escape_codes.h"
#include "cli/terminal.h"
#include "daemon/config/printable.h"

namespace gaitd::cli::teleop {
namespace {

constexpr int kLastWords = 500;  // ms that a terminal gets to take them

// O_NONBLOCK belongs to what was opened, not to the descriptor: on standard output the shell would
// have it too. So the terminal is opened once more.
int open_again(int descriptor) {
  char name[128];
  if (ttyname_r(descriptor, name, sizeof(name)) != 0) return -1;
  return open(name, O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
}

winsize window() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) size = {};
  if (size.ws_col == 0) size.ws_col = 80;
  if (size.ws_row == 0) size.ws_row = 24;
  return size;
}

}  // namespace

bool has_keyboard() {
  termios settings{};
  return isatty(STDIN_FILENO) != 0 && tcgetattr(STDIN_FILENO, &settings) == 0;
}

Console::Console()
    : screen_(takes_escape_codes(STDOUT_FILENO)), colors_(shows_colors(STDOUT_FILENO)) {
  tcgetattr(STDIN_FILENO, &before_);
  if (isatty(STDOUT_FILENO) != 0) out_ = open_again(STDOUT_FILENO);
  enter();
}

Console::~Console() {
  leave();
  if (out_ >= 0) close(out_);
}

void Console::enter() {
  termios raw = before_;
  // Ctrl-S would hold up the picture, Ctrl-V the key after it, Ctrl-\ would leave all this behind.
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO | IEXTEN);
  raw.c_iflag &= ~static_cast<tcflag_t>(IXON | ICRNL | INLCR);
  raw.c_cc[VMIN] = 1;
  raw.c_cc[VTIME] = 0;
  raw.c_cc[VQUIT] = _POSIX_VDISABLE;
  tcsetattr(STDIN_FILENO, TCSANOW, &raw);
  tcflush(STDIN_FILENO, TCIFLUSH);  // what was typed before is not meant for the robot
  shown_.clear();
  if (screen_) put(escape::kEnter);
}

void Console::leave() {
  if (screen_) waiting_ += escape::kLeave;
  for (int waited = 0; !flush() && !ended_ && waited < kLastWords; waited += 50) {
    pollfd terminal{out_ >= 0 ? out_ : STDOUT_FILENO, POLLOUT, 0};
    poll(&terminal, 1, 50);
  }
  waiting_.clear();
  tcflush(STDIN_FILENO, TCIFLUSH);  // a key that still repeats is not meant for the shell
  tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

std::size_t Console::columns() const { return window().ws_col; }

std::size_t Console::rows() const { return window().ws_row; }

// True if nothing is left.
bool Console::flush() {
  while (!waiting_.empty()) {
    const int fd = out_ >= 0 ? out_ : STDOUT_FILENO;
    pollfd terminal{fd, POLLOUT, 0};
    if (poll(&terminal, 1, 0) <= 0) return false;
    const ssize_t n = write(fd, waiting_.data(), waiting_.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && errno == EAGAIN) return false;
    if (n <= 0) {
      ended_ = true;
      return false;
    }
    waiting_.erase(0, static_cast<std::size_t>(n));
  }
  return true;
}

void Console::put(const std::string& text) {
  waiting_ += text;
  flush();
}

void Console::draw(const std::vector<Line>& lines) {
  if (!flush()) return;
  const winsize size = window();
  std::string picture = escape::kHome;
  for (std::size_t i = 0; i < lines.size() && i < size.ws_row; ++i) {
    if (i > 0) picture += "\r\n";
    const bool colored = colors_ && lines[i].tone != Line::Tone::kPlain;
    if (colored) picture += lines[i].tone == Line::Tone::kGood ? escape::kGreen : escape::kRed;
    picture += cut_to_width(daemon::printable(lines[i].text), size.ws_col);
    if (colored) picture += escape::kNoColor;
    picture += escape::kClearLine;
  }
  if (lines.size() < size.ws_row) picture += std::string("\r\n") + escape::kClearBelow;
  const std::string key = picture + std::to_string(size.ws_col) + 'x' + std::to_string(size.ws_row);
  if (key == shown_) return;
  shown_ = key;
  put(picture);
}

void Console::print(const std::string& line) {
  if (flush()) put(daemon::printable(line) + "\n");
}

std::string Console::read() {
  std::string bytes;
  for (;;) {
    pollfd keys{STDIN_FILENO, POLLIN, 0};
    if (poll(&keys, 1, 0) <= 0 || keys.revents == 0) return bytes;
    char chunk[256];
    const ssize_t n = ::read(STDIN_FILENO, chunk, sizeof(chunk));
    if (n < 0 && (errno == EINTR || errno == EAGAIN)) return bytes;
    if (n <= 0) {
      ended_ = true;
      return bytes;
    }
    bytes.append(chunk, static_cast<std::size_t>(n));
  }
}

void Console::suspend() {
  leave();
  SuspendSignal::suspend();
  enter();
}

}  // namespace gaitd::cli::teleop
