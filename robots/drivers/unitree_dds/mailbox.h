// SPDX-License-Identifier: Apache-2.0
// The newest value of one process, read by others through shared memory.
#pragma once

#include <linux/futex.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace gaitd::unitree {

// One thread puts, any number gets; nobody waits, and whoever dies in the middle leaves the last
// whole value behind. All zero is an empty one, so that fresh shared memory needs no constructor.
template <class T>
class Mailbox {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  void put(const T& value) {
    std::array<uint64_t, kWords> words{};
    std::memcpy(words.data(), &value, sizeof(T));
    const uint64_t next = count_.load(std::memory_order_relaxed) + 1;
    std::atomic_thread_fence(std::memory_order_release);
    Slot& slot = slots_[next % kSlotCount];
    for (size_t i = 0; i < kWords; ++i) slot[i].store(words[i], std::memory_order_relaxed);
    count_.store(next, std::memory_order_release);
  }

  // How many values have been put when the one in `value` was the newest; 0: none.
  uint64_t get(T* value) const {
    std::array<uint64_t, kWords> words;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      const uint64_t count = count_.load(std::memory_order_acquire);
      if (count == 0) return 0;
      const Slot& slot = slots_[count % kSlotCount];
      for (size_t i = 0; i < kWords; ++i) words[i] = slot[i].load(std::memory_order_relaxed);
      std::atomic_thread_fence(std::memory_order_acquire);
      // The slot is written again only after kSlotCount - 1 newer ones.
      if (count_.load(std::memory_order_relaxed) - count >= kSlotCount - 1) continue;
      std::memcpy(value, words.data(), sizeof(T));
      return count;
    }
    return 0;
  }

  uint64_t count() const { return count_.load(std::memory_order_acquire); }

 private:
  static constexpr size_t kWords = (sizeof(T) + 7) / 8;
  static constexpr uint64_t kSlotCount = 4;
  static constexpr int kAttempts = 8;
  using Slot = std::array<std::atomic<uint64_t>, kWords>;
  std::atomic<uint64_t> count_;
  std::array<Slot, kSlotCount> slots_;
};

// Wakes threads of other processes. All zero is one that never rang.
class Bell {
 public:
  uint32_t rings() const { return rings_.load(std::memory_order_acquire); }
  void ring() {
    rings_.fetch_add(1, std::memory_order_acq_rel);
    syscall(SYS_futex, &rings_, FUTEX_WAKE, INT32_MAX, nullptr, nullptr, 0);
  }
  // Until it rings for the first time after `seen`, at most so long (s).
  void wait(uint32_t seen, double seconds) const {
    if (seconds <= 0) return;
    const timespec time{static_cast<time_t>(seconds),
                        static_cast<long>(1e9 * (seconds - std::floor(seconds)))};
    syscall(SYS_futex, &rings_, FUTEX_WAIT, seen, &time, nullptr, 0);
  }

 private:
  std::atomic<uint32_t> rings_;
};

}  // namespace gaitd::unitree
