// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <string>
#include <utility>

namespace gaitd::cli {

struct ProgressCounts {
  std::size_t done = 0, total = 0;  ///< `total` is larger than 0
  int failed = 0;
  int finished = 0;  ///< of `done`, since the bar is there: what the time left is told from
};

/// A bar that stays in its line on a terminal, else a line now and then.
class ProgressBar {
 public:
  /// `what` stands before the bar.
  explicit ProgressBar(std::string what) : what_(std::move(what)) {}

  /// `more` stands behind the counts.
  void show(const ProgressCounts& counts, const std::string& more = "");
  void end() const;

 private:
  std::string what_;
  bool terminal_ = isatty(STDERR_FILENO) != 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  int shown_ = 0;
  std::string more_;
  std::size_t last_step_ = 0;
};

}  // namespace gaitd::cli
