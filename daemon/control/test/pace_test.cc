// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/pace.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "walking/test/tick.h"

namespace gaitd::daemon {
namespace {

using testing::kDt;

constexpr double kRun = 0.01;  // s

// A loop that begins its ticks when they are due, on a clock that only moves as it is told.
class Loop {
 public:
  explicit Loop(OverrunPolicy policy) : pace_(kDt, policy, kRun) { pace_.start(now_); }
  // A tick that takes this long (s), and the wait for the next one.
  Pace::Next tick(double seconds) {
    now_ += static_cast<std::int64_t>(1e9 * seconds);
    const Pace::Next next = pace_.after_tick(now_);
    now_ = std::max(now_, next.due);
    return next;
  }
  double behind() const { return pace_.behind(); }
  std::int64_t now() const { return now_; }

 private:
  Pace pace_;
  std::int64_t now_ = 1'000'000'000'000;
};

TEST(Pace, TicksThatAreInTimeAreDueEveryPeriod) {
  Loop loop(OverrunPolicy::kStop);
  const std::int64_t start = loop.now();
  for (int i = 1; i <= 1000; ++i) {
    const Pace::Next next = loop.tick(i % 2 == 0 ? 0.0009 : 0.001);
    EXPECT_EQ(next.due, start + i * 1'000'000);
    EXPECT_FALSE(next.overrun || next.fault);
  }
}

TEST(Pace, OneLongStallIsAFaultAtOnce) {
  Loop loop(OverrunPolicy::kStop);
  loop.tick(0.0005);
  const Pace::Next stall = loop.tick(0.5);
  EXPECT_TRUE(stall.overrun);
  EXPECT_TRUE(stall.fault);
  EXPECT_NEAR(loop.behind(), 0.499, 1e-9);
}

TEST(Pace, AStallUpToTheLongestRunIsNone) {
  for (const double past : {-1e-6, 1e-6}) {
    Loop loop(OverrunPolicy::kStop);
    EXPECT_EQ(loop.tick(kDt + kRun + past).fault, past > 0.0);
  }
}

TEST(Pace, SlowTicksInARowAreAFaultOnceTheyLastTooLong) {
  Loop loop(OverrunPolicy::kStop);
  double lasted = 0.0;
  while (!loop.tick(0.0015).fault) {
    lasted += 0.002;  // 0.5 ms late, and the next one that is due
    ASSERT_LT(lasted, 1.0);
  }
  EXPECT_NEAR(lasted, kRun, 0.0021);
}

TEST(Pace, TicksThatAreVeryLongAreAFaultFromTheFirstOn) {
  Loop loop(OverrunPolicy::kStop);
  for (int i = 0; i < 25; ++i) EXPECT_TRUE(loop.tick(0.9).fault);
}

TEST(Pace, ATickInTimeEndsTheRun) {
  Loop loop(OverrunPolicy::kStop);
  for (int i = 0; i < 1000; ++i) {
    for (int late = 0; late < 3; ++late) EXPECT_FALSE(loop.tick(0.0015).fault);
    EXPECT_FALSE(loop.tick(0.0005).overrun);
    EXPECT_EQ(loop.behind(), 0.0);
  }
}

TEST(Pace, SkippedTicksAreLeftOutAndTheNextOneIsOnTheGrid) {
  Loop loop(OverrunPolicy::kSkip);
  const std::int64_t start = loop.now();
  const Pace::Next next = loop.tick(0.0525);
  EXPECT_TRUE(next.overrun);
  EXPECT_FALSE(next.fault);  // is not asked for
  EXPECT_EQ(next.due, start + 53'000'000);
}

TEST(Pace, TicksAreMadeUpForUnlessTheyAreTooMany) {
  Loop few(OverrunPolicy::kCatchUp);
  const std::int64_t start = few.now();
  EXPECT_EQ(few.tick(0.0045).due, start + 1'000'000);
  for (int i = 2; i <= 5; ++i) EXPECT_EQ(few.tick(0.0).due, start + i * 1'000'000);
  EXPECT_EQ(few.behind(), 0.0);
  Loop many(OverrunPolicy::kCatchUp);
  EXPECT_EQ(many.tick(0.5005).due, start + 501'000'000);
}

}  // namespace
}  // namespace gaitd::daemon
