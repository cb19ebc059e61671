// SPDX-License-Identifier: Apache-2.0
#include "daemon/verdict/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

namespace gaitd::daemon {
namespace {

TEST(Statistics, HaveTheirTextbookValues) {
  const std::vector<double> values = {3.0, -4.0, 1.0, 0.0};
  EXPECT_DOUBLE_EQ(compute_statistic(Statistic::kRms, values), std::sqrt(26.0 / 4.0));
  EXPECT_DOUBLE_EQ(compute_statistic(Statistic::kMean, values), 0.0);
  EXPECT_EQ(compute_statistic(Statistic::kMin, values), -4.0);
  EXPECT_EQ(compute_statistic(Statistic::kMax, values), 3.0);
  EXPECT_EQ(compute_statistic(Statistic::kRange, values), 7.0);
}

TEST(Statistics, TheNinetyNinthPercentileLeavesOneInAHundredAbove) {
  std::vector<double> values(1000);
  std::iota(values.rbegin(), values.rend(), 1.0);
  EXPECT_EQ(compute_statistic(Statistic::kP99, values), 990.0);
  EXPECT_EQ(compute_statistic(Statistic::kP99, std::vector<double>{5.0}), 5.0);
  EXPECT_EQ(compute_statistic(Statistic::kP99, std::vector<double>{5.0, 7.0}), 7.0);
}

TEST(Statistics, NothingAndNaNGiveNaN) {
  for (int i = 0; i < 6; ++i) {
    EXPECT_TRUE(std::isnan(compute_statistic(static_cast<Statistic>(i), {})));
    EXPECT_TRUE(std::isnan(
        compute_statistic(static_cast<Statistic>(i), std::vector<double>{1.0, std::nan("")})));
  }
}

TEST(Words, AreThoseOfScenarioFiles) {
  EXPECT_EQ(parse_statistic("p99"), Statistic::kP99);
  EXPECT_EQ(parse_during("walk"), During::kWalk);
  EXPECT_EQ(parse_statistic("median"), std::nullopt);
  EXPECT_EQ(parse_during(""), std::nullopt);
  for (int i = 0; i < 6; ++i) {
    const auto statistic = static_cast<Statistic>(i);
    EXPECT_EQ(parse_statistic(statistic_name(statistic)), statistic);
  }
  for (int i = 0; i < 5; ++i) {
    const auto during = static_cast<During>(i);
    EXPECT_EQ(parse_during(during_name(during)), during);
  }
}

}  // namespace
}  // namespace gaitd::daemon
