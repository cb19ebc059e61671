// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cli/campaign/groups.h"

namespace gaitd::cli {
namespace {

TEST(Wilson, GivesTheKnownIntervals) {
  const SuccessInterval most = wilson_interval(49, 50);
  EXPECT_NEAR(most.low, 0.895, 1e-3);
  EXPECT_NEAR(most.high, 0.9965, 1e-3);
  const SuccessInterval none = wilson_interval(0, 10);
  EXPECT_NEAR(none.low, 0.0, 1e-12);
  EXPECT_NEAR(none.high, 0.2775, 1e-3);
  EXPECT_EQ(wilson_interval(0, 0).high, 1.0);
}

TEST(Percent, IsAllOnlyOfAllAndNoneOnlyOfNone) {
  EXPECT_EQ(percent_text(0.0), "0.0 %");
  EXPECT_EQ(percent_text(0.5), "50.0 %");
  EXPECT_EQ(percent_text(1.0), "100.0 %");
  EXPECT_EQ(percent_text(0.9996), "99.96 %");
  EXPECT_EQ(percent_text(0.999996), "99.9996 %");
  EXPECT_EQ(percent_text(0.00004), "0.004 %");
  EXPECT_EQ(percent_text(1.0 - 1e-16), "100.0 %");  // rounding
}

// As R's binom.test(k, n) gives it.
TEST(McNemar, IsExact) {
  EXPECT_EQ(mcnemar(0, 0), 1.0);
  EXPECT_NEAR(mcnemar(0, 5), 0.0625, 1e-12);
  EXPECT_NEAR(mcnemar(6, 0), 0.03125, 1e-12);
  EXPECT_NEAR(mcnemar(2, 9), 0.0654296875, 1e-12);
  EXPECT_EQ(mcnemar(4, 4), 1.0);
  EXPECT_LT(mcnemar(51000, 49000), 1e-9);
  EXPECT_NEAR(mcnemar(50000, 50000), 1.0, 1e-6);
}

TEST(McNemar, SaysHowManyPairsWouldDecide) {
  EXPECT_FALSE(pairs_for_shares(3, 3, 100));
  // Shares of 10 % and 5 % that differ: (1.96 sqrt(0.15) + 0.8416 sqrt(0.1475))² / 0.05².
  const auto needed = pairs_for_shares(10, 5, 100);
  ASSERT_TRUE(needed);
  EXPECT_EQ(*needed, 469.0);
  EXPECT_LT(*pairs_for_shares(20, 2, 100), 60.0);
}

TEST(Bootstrap, HoldsTheMeanAndIsTheSameEachTime) {
  std::vector<double> values;
  for (int i = 0; i < 400; ++i) values.push_back(1.0 + std::sin(i));
  const MeanInterval once = bootstrap_mean(values, "a"), again = bootstrap_mean(values, "a");
  EXPECT_EQ(once.low, again.low);
  EXPECT_EQ(once.high, again.high);
  EXPECT_NE(once.low, bootstrap_mean(values, "b").low);
  // The standard error of 400 values with a deviation of 0.707.
  EXPECT_NEAR(once.mean - once.low, 1.96 * 0.707 / 20.0, 0.01);
  EXPECT_NEAR(once.high - once.mean, 1.96 * 0.707 / 20.0, 0.01);
  EXPECT_EQ(bootstrap_mean({2.5, 2.5}, "a").low, 2.5);
}

TEST(Bootstrap, SaysHowManyValuesWouldDecide) {
  // Mean 1, deviation 2: (2.8016 · 2)² = 31.4.
  EXPECT_EQ(values_for_mean({3.0, -1.0, 3.0, -1.0, 3.0, -1.0, 3.0, -1.0, 1.0}).value_or(0), 32.0);
  EXPECT_FALSE(values_for_mean({1.0, -1.0}));
  EXPECT_FALSE(values_for_mean({1.0}));
}

}  // namespace
}  // namespace gaitd::cli
