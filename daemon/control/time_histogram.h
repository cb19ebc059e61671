// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>

namespace gaitd::daemon {

// How often times were met, in buckets of 6 % and less. One thread adds, any thread reads; neither
// waits for the other.
class TimeHistogram {
 public:
  // [rt, one thread] `microseconds` below 1/16 count as that, beyond 2 s as that.
  void add(double microseconds) noexcept {
    std::atomic<std::uint32_t>& bucket = buckets_[bucket_of(microseconds)];
    bucket.store(bucket.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    if (microseconds > max_.load(std::memory_order_relaxed)) {
      max_.store(microseconds, std::memory_order_relaxed);
    }
  }

  // [any thread]
  struct Figures {
    std::uint64_t count = 0;
    double median = 0.0;  // µs; zero without any
    double p99 = 0.0;
    double max = 0.0;
  };
  Figures figures() const noexcept {
    std::array<std::uint32_t, kBuckets> counts;
    Figures f;
    for (int i = 0; i < kBuckets; ++i) {
      counts[i] = buckets_[i].load(std::memory_order_relaxed);
      f.count += counts[i];
    }
    f.max = max_.load(std::memory_order_relaxed);
    const auto quantile = [&](double share) {
      auto left = static_cast<std::uint64_t>(share * static_cast<double>(f.count));
      for (int i = 0; i < kBuckets; ++i) {
        if (left < counts[i]) return std::min(middle_of(i), f.max);
        left -= counts[i];
      }
      return f.max;
    };
    f.median = quantile(0.5);
    f.p99 = quantile(0.99);
    return f;
  }

 private:
  // Each power of two is divided into 16: the exponent and the first four bits of the fraction.
  static constexpr int kShift = 48;  // of what remains of a double
  static constexpr double kLeast = 0.0625;
  static constexpr double kMost = 2e6;
  static constexpr std::uint64_t kFirst = std::bit_cast<std::uint64_t>(kLeast) >> kShift;
  static constexpr int kBuckets =
      static_cast<int>((std::bit_cast<std::uint64_t>(kMost) >> kShift) - kFirst) + 1;

  static int bucket_of(double microseconds) noexcept {
    const double inside = microseconds >= kLeast ? std::min(microseconds, kMost) : kLeast;
    return static_cast<int>((std::bit_cast<std::uint64_t>(inside) >> kShift) - kFirst);
  }
  static double middle_of(int bucket) noexcept {
    const std::uint64_t at = kFirst + static_cast<std::uint64_t>(bucket);
    return 0.5 * (std::bit_cast<double>(at << kShift) + std::bit_cast<double>((at + 1) << kShift));
  }

  std::array<std::atomic<std::uint32_t>, kBuckets> buckets_{};
  std::atomic<double> max_{0.0};
};

}  // namespace gaitd::daemon
