// SPDX-License-Identifier: Apache-2.0
// A wait-free queue from one thread to another.
#ifndef GAITD_SIM_SPSC_RING_H_
#define GAITD_SIM_SPSC_RING_H_

#include <atomic>
#include <cstddef>
#include <memory>

namespace gaitd::sim {

// Exactly one thread pushes and exactly one pops. Holds up to `Capacity` elements, which are
// allocated on construction.
template <typename T, size_t Capacity>
class SpscRing {
 public:
  SpscRing() : slots_(std::make_unique<T[]>(Capacity)) {}

  // False: full, nothing is stored.
  bool push(const T& value) {
    const size_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_.load(std::memory_order_acquire) == Capacity) return false;
    slots_[head % Capacity] = value;
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  // False: empty.
  bool pop(T* value) {
    const size_t tail = tail_.load(std::memory_order_relaxed);
    if (head_.load(std::memory_order_acquire) == tail) return false;
    *value = slots_[tail % Capacity];
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

 private:
  std::unique_ptr<T[]> slots_;
  alignas(64) std::atomic<size_t> head_{0};
  alignas(64) std::atomic<size_t> tail_{0};
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_SPSC_RING_H_
