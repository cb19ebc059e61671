// SPDX-License-Identifier: Apache-2.0
#include "cli/teleop/pad.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>

namespace gaitd::cli::teleop {

EventStream::~EventStream() { close(fd_); }

PadEvents::Result EventStream::next(input_event* event) {
  for (;;) {
    char* rest = reinterpret_cast<char*>(&partial_) + filled_;
    const ssize_t n = ::read(fd_, rest, sizeof(partial_) - filled_);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && errno == EAGAIN) return Result::kNone;
    if (n <= 0) return Result::kGone;
    filled_ += static_cast<std::size_t>(n);
    if (filled_ < sizeof(partial_)) continue;
    filled_ = 0;
    *event = partial_;
    return Result::kEvent;
  }
}

void Pad::read() {
  while (events_) {
    input_event event{};
    switch (events_->next(&event)) {
      case PadEvents::Result::kEvent:
        state_.take(event);
        break;
      case PadEvents::Result::kNone:
        return;
      case PadEvents::Result::kGone:
        state_.let_go();
        events_.reset();
        return;
    }
  }
}

std::vector<std::string> pad_devices() {
  std::vector<std::string> paths;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/input", ignored)) {
    if (entry.path().filename().string().starts_with("event")) paths.push_back(entry.path());
  }
  // event2 before event10.
  std::ranges::sort(paths, [](const std::string& a, const std::string& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  });
  return paths;
}

}  // namespace gaitd::cli::teleop
