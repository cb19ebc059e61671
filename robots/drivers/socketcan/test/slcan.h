// SPDX-License-Identifier: Apache-2.0
// A CAN interface whose wire is a pseudo terminal: the test is everybody else on the bus.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/tty.h>
#include <net/if.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "frame.h"

namespace gaitd::can {

class Slcan {
 public:
  Slcan() {
    EXPECT_EQ(0, openpty(&master_, &slave_, nullptr, nullptr, nullptr));
    termios raw{};
    tcgetattr(slave_, &raw);
    cfmakeraw(&raw);
    tcsetattr(slave_, TCSANOW, &raw);
    int discipline = N_SLCAN;
    EXPECT_EQ(0, ioctl(slave_, TIOCSETD, &discipline)) << std::strerror(errno);
    ifreq request{};
    EXPECT_EQ(0, ioctl(slave_, SIOCGIFNAME, request.ifr_name));
    name_ = request.ifr_name;
    fcntl(master_, F_SETFL, O_NONBLOCK);
    set_up(true);
  }
  ~Slcan() {
    close(slave_);
    close(master_);
  }

  const std::string& name() const { return name_; }
  void set_up(bool up) {
    const std::string line = "ip link set " + name_ + (up ? " up" : " down");
    EXPECT_EQ(0, std::system(line.c_str())) << line;
  }
  // In the protocol of the adapter: frames, and reports of the state of the bus.
  void say(const std::string& line) {
    const std::string text = line + "\r";
    EXPECT_EQ(static_cast<ssize_t>(text.size()), write(master_, text.data(), text.size()));
    usleep(20000);
  }
  void bus_off() { say("sb000256"); }
  void send(const Frame& frame) {
    char text[48];
    const bool extended = (frame.id & kExtended) != 0;
    int length = std::snprintf(text, sizeof(text), extended ? "T%08X%d" : "t%03X%d",
                               frame.id & ~kExtended, frame.length);
    for (int i = 0; i < frame.length; ++i) {
      length += std::snprintf(text + length, sizeof(text) - length, "%02X", frame.data[i]);
    }
    say(text);
  }
  // The frames that came since the last call.
  std::vector<Frame> take() {
    // The adapter sends a frame when the one before has been read.
    char bytes[4096];
    for (ssize_t got = 1; got > 0;) {
      usleep(20000);
      got = read(master_, bytes, sizeof(bytes));
      if (got > 0) text_.append(bytes, got);
    }
    std::vector<Frame> frames;
    for (size_t end; (end = text_.find('\r')) != std::string::npos; text_.erase(0, end + 1)) {
      Frame frame;
      unsigned id = 0, length = 0;
      const bool extended = text_[0] == 'T';
      if (std::sscanf(text_.c_str(), extended ? "T%8x%1u" : "t%3x%1u", &id, &length) != 2) continue;
      frame.id = id | (extended ? kExtended : 0);
      const size_t begin = extended ? 10 : 5;
      frame.length = static_cast<uint8_t>(length);
      for (unsigned i = 0; i < length; ++i) {
        frame.data[i] =
            static_cast<uint8_t>(std::strtoul(text_.substr(begin + 2 * i, 2).c_str(), nullptr, 16));
      }
      frames.push_back(frame);
    }
    return frames;
  }

 private:
  int master_ = -1, slave_ = -1;
  std::string name_, text_;
};

}  // namespace gaitd::can
