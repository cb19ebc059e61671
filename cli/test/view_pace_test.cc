// SPDX-License-Identifier: Apache-2.0
#include "cli/view/pace.h"

#include <gtest/gtest.h>

#include <random>

#include "cli/live/message.h"

namespace gaitd::cli {
namespace {

// Of frames that come `rate` times a second, each up to `jitter` s late, those in ten seconds.
int taken(double wanted, double rate, double jitter) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> late(0.0, jitter);
  Pace pace(wanted);
  int count = 0;
  for (int i = 0; i < static_cast<int>(10 * rate); ++i) {
    const std::chrono::duration<double> now(1000.0 + i / rate + late(random));
    if (pace.due(Pace::Clock::time_point(std::chrono::duration_cast<Pace::Clock::duration>(now)))) {
      ++count;
    }
  }
  return count;
}

TEST(Pace, AsManyComeAsAreWantedWhateverTheRateOfTheSource) {
  EXPECT_NEAR(taken(60, 100, 0), 600, 3);
  EXPECT_NEAR(taken(30, 100, 0), 300, 3);
  EXPECT_NEAR(taken(30, 60, 0), 300, 3);
  EXPECT_NEAR(taken(5, 60, 0), 50, 2);
}

TEST(Pace, NothingIsLeftOutOfWhatIsNoFasterThanWanted) {
  EXPECT_EQ(taken(60, 60, 0.006), 600);
  EXPECT_EQ(taken(60, 30, 0.02), 300);
}

TEST(Pace, NobodyGetsMoreThanTheHighestOrWaitsForever) {
  EXPECT_NEAR(taken(1e9, 200, 0), 600, 3);
  EXPECT_NEAR(taken(-5, 60, 0), 10, 2);
}

TEST(ViewMessage, WhatIsNestedTooDeeplyIsNoMessage) {
  const auto nested = [](std::size_t depth) {
    return std::string(depth, '[') + std::string(depth, ']');
  };
  EXPECT_TRUE(parse_message(nested(32)).is_array());
  EXPECT_TRUE(parse_message(nested(33)).is_discarded());
  EXPECT_TRUE(parse_message(R"({"text": "\"[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[["})").is_object());
  EXPECT_TRUE(parse_message("{").is_discarded());
}

}  // namespace
}  // namespace gaitd::cli
