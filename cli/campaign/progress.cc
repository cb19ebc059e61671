// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/progress.h"

#include <cstdio>

namespace gaitd::cli {
namespace {

std::string duration_text(double seconds) {
  char text[32];
  const auto whole = static_cast<long>(seconds + 0.5);
  std::snprintf(text, sizeof(text), "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
  return text;
}

}  // namespace

void ProgressBar::show(const ProgressCounts& counts, const std::string& more) {
  const auto [done, total, failed, finished] = counts;
  if (!terminal_ && more == more_ &&
      (finished == shown_ || (done * 20 / total == last_step_ && done < total))) {
    return;
  }
  more_ = more;
  last_step_ = done * 20 / total;
  shown_ = finished;
  constexpr std::size_t kWidth = 30;
  const std::size_t filled = done * kWidth / total;
  const double passed =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const std::string left =
      finished > 0 ? duration_text(passed / finished * static_cast<double>(total - done)) + " left"
                   : "";
  std::fprintf(stderr, "%s%s[%s%s] %zu/%zu, %d failed, %s%s%s%s", terminal_ ? "\r" : "",
               what_.c_str(), std::string(filled, '#').c_str(),
               std::string(kWidth - filled, '.').c_str(), done, total, failed, more.c_str(),
               more.empty() ? "" : ", ", left.c_str(), terminal_ ? "\033[K" : "\n");
  std::fflush(stderr);
}

void ProgressBar::end() const {
  if (terminal_) std::fputs("\r\033[K", stderr);
}

}  // namespace gaitd::cli
