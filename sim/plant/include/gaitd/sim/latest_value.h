// SPDX-License-Identifier: Apache-2.0
// The newest value of one thread, read wait-free by another (a triple buffer).
#ifndef GAITD_SIM_LATEST_VALUE_H_
#define GAITD_SIM_LATEST_VALUE_H_

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>

namespace gaitd::sim {

// One thread writes, one reads. Values in between are lost, torn ones never seen.
template <typename T>
class LatestValue {
 public:
  LatestValue() : slots_(std::make_unique<std::array<T, 3>>()) {}

  // Writer: the slot to fill; publish() makes it the newest.
  T& back() { return (*slots_)[back_]; }
  void publish() { back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kIndex; }

  // Reader: takes the newest value as front(). False: there is none newer than front().
  bool take() {
    if (!(middle_.load(std::memory_order_relaxed) & kFresh)) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    return true;
  }
  const T& front() const { return (*slots_)[front_]; }

 private:
  static constexpr uint32_t kFresh = 4;
  static constexpr uint32_t kIndex = 3;
  std::unique_ptr<std::array<T, 3>> slots_;
  uint32_t back_ = 0;
  uint32_t front_ = 1;
  std::atomic<uint32_t> middle_{2};
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_LATEST_VALUE_H_
