// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/tick_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>

namespace gaitd::daemon {
namespace {

TEST(TimeHistogram, FindsMedianAndP99WithinSixPercentAndTheMaximumExactly) {
  TimeHistogram histogram;
  for (int i = 1; i <= 1000; ++i) histogram.add(0.37 * i);
  const TimeHistogram::Figures f = histogram.figures();
  EXPECT_EQ(f.count, 1000u);
  EXPECT_NEAR(f.median, 0.37 * 500, 0.06 * 0.37 * 500);
  EXPECT_NEAR(f.p99, 0.37 * 990, 0.06 * 0.37 * 990);
  EXPECT_EQ(f.max, 370.0);
}

TEST(TimeHistogram, TakesAnyNumber) {
  TimeHistogram histogram;
  EXPECT_EQ(histogram.figures().count, 0u);
  EXPECT_EQ(histogram.figures().p99, 0.0);
  for (double t : {0.0, -1.0, 1e-9, 1e12, std::numeric_limits<double>::infinity(),
                   std::numeric_limits<double>::quiet_NaN()}) {
    histogram.add(t);
  }
  EXPECT_EQ(histogram.figures().count, 6u);
}

TEST(TimeHistogram, IsReadWhileItGrows) {
  TimeHistogram histogram;
  std::thread writer([&] {
    for (int i = 0; i < 200000; ++i) histogram.add(10.0);
  });
  for (std::uint64_t count = 0; count < 200000;) {
    const TimeHistogram::Figures f = histogram.figures();
    ASSERT_GE(f.count, count);
    count = f.count;
    if (count > 0) ASSERT_NEAR(f.median, 10.0, 0.6);
    std::this_thread::yield();
  }
  writer.join();
}

constexpr TickWatch::Budgets kBudgets = {60, 60, 50, 30, 400};

TickTimes times(double wbc, double wake_up = 5.0) {
  TickTimes t;
  t.layer_us = {10, 5, 5, 1, wbc};
  t.total_us = 30 + wbc;
  t.jitter_us = wake_up;
  return t;
}

TEST(TickWatch, CountsTicksOverTheBudgetOfALayer) {
  TickWatch watch(0.001);
  for (int tick = 0; tick < 10; ++tick) watch.add(tick, times(tick < 7 ? 40 : 450), kBudgets);
  const TickWatch::Report r = watch.report();
  EXPECT_EQ(r.layers[GAITD_LAYER_WHOLE_BODY_CONTROLLER].over, 3u);
  EXPECT_EQ(r.layers[GAITD_LAYER_STATE_ESTIMATOR].over, 0u);
  EXPECT_EQ(r.layers[GAITD_LAYER_WHOLE_BODY_CONTROLLER].budget, 400.0);
  EXPECT_EQ(r.total.count, 10u);
  EXPECT_EQ(r.overruns, 0u);
  EXPECT_EQ(r.late.what, GAITD_LAYER_WHOLE_BODY_CONTROLLER);
  EXPECT_EQ(r.late.tick, 9);
  EXPECT_EQ(r.late.time, 450.0);
}

TEST(TickWatch, NamesWhatMadeTheTickLate) {
  TickWatch watch(0.001);
  EXPECT_EQ(watch.report().late.what, -1);
  watch.add(1, times(1500), kBudgets);
  EXPECT_EQ(watch.overrun(), GAITD_LAYER_WHOLE_BODY_CONTROLLER);
  watch.add(2, times(40, 3000), kBudgets);
  EXPECT_EQ(watch.overrun(), kLateWakeUp);
  TickTimes backend = times(40);
  backend.total_us = 2000;
  watch.add(3, backend, kBudgets);
  EXPECT_EQ(watch.overrun(), kLateRest);
  TickTimes estimator = times(500);
  estimator.layer_us[GAITD_LAYER_STATE_ESTIMATOR] = 900;
  estimator.total_us = 1500;
  watch.add(4, estimator, kBudgets);
  EXPECT_EQ(watch.overrun(), GAITD_LAYER_STATE_ESTIMATOR);
  // A layer that is late without an overrun does not take its place.
  watch.add(5, times(450), kBudgets);
  const TickWatch::Report r = watch.report();
  EXPECT_EQ(r.overruns, 4u);
  EXPECT_STREQ(late_name(r.late.what), "state_estimator");
  EXPECT_EQ(r.late.tick, 4);
  EXPECT_STREQ(late_name(kLateWakeUp), "wake_up");
  EXPECT_STREQ(late_name(kLateRest), "rest of the tick");
}

}  // namespace
}  // namespace gaitd::daemon
