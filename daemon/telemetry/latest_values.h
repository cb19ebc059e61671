// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

namespace gaitd::daemon {

/// The newest row of values, from one writer that waits for nobody to any number of readers that
/// wait for each other only: a triple buffer.
class LatestValues {
 public:
  explicit LatestValues(std::size_t size) : rows_{Row(size), Row(size), Row(size)} {}

  // ---- The writer. [rt]

  /// The row to fill; holds what an earlier one left there.
  std::span<double> next() noexcept { return rows_[next_]; }
  void publish() noexcept {
    const std::uint8_t was = shared_.exchange(next_ | kFresh, std::memory_order_acq_rel);
    next_ = was & kIndex;
  }

  // ---- Any other thread.

  /// False before the first publish(); `values` is left alone then.
  bool copy(std::vector<double>& values) const {
    const std::scoped_lock lock(readers_);
    if ((shared_.load(std::memory_order_acquire) & kFresh) != 0) {
      newest_ = shared_.exchange(newest_, std::memory_order_acq_rel) & kIndex;
      any_ = true;
    }
    if (any_) values = rows_[newest_];
    return any_;
  }

 private:
  using Row = std::vector<double>;
  static constexpr std::uint8_t kIndex = 3;
  static constexpr std::uint8_t kFresh = 4;  // nobody has read the shared row yet

  Row rows_[3];
  std::uint8_t next_ = 0;  // of the writer
  mutable std::atomic<std::uint8_t> shared_{1};
  mutable std::mutex readers_;
  mutable std::uint8_t newest_ = 2;  // of the readers
  mutable bool any_ = false;
};

}  // namespace gaitd::daemon
