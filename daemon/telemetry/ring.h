// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <bit>
#include <cstdint>

namespace gaitd::daemon {

// The indexes of a wait-free ring with one producer and one consumer thread; the slots themselves
// belong to whoever uses it. Counts only grow, a slot is its count modulo the capacity.
class RingIndexes {
 public:
  // Rounded up to a power of two.
  explicit RingIndexes(std::size_t capacity) : capacity_(std::bit_ceil(capacity)) {}

  std::size_t capacity() const { return capacity_; }

  // Any thread: slots that wait for the consumer, at about this moment.
  std::size_t used() const noexcept {
    const std::uint64_t read = read_.load(std::memory_order_acquire);
    return static_cast<std::size_t>(written_.load(std::memory_order_acquire) - read);
  }

  // Producer. Free slots; at least as many stay free until it commits.
  std::size_t free() const noexcept {
    return capacity_ - static_cast<std::size_t>(written_.load(std::memory_order_relaxed) -
                                                read_.load(std::memory_order_acquire));
  }
  std::size_t write_slot() const noexcept {
    return static_cast<std::size_t>(written_.load(std::memory_order_relaxed)) & (capacity_ - 1);
  }
  void commit() noexcept {
    written_.store(written_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }

  // Consumer.
  bool empty() const noexcept {
    return read_.load(std::memory_order_relaxed) == written_.load(std::memory_order_acquire);
  }
  std::size_t read_slot() const noexcept {
    return static_cast<std::size_t>(read_.load(std::memory_order_relaxed)) & (capacity_ - 1);
  }
  void release() noexcept {
    read_.store(read_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }

 private:
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

  std::size_t capacity_;
  alignas(64) std::atomic<std::uint64_t> written_{0};  // apart: each thread writes its own line
  alignas(64) std::atomic<std::uint64_t> read_{0};
};

}  // namespace gaitd::daemon
