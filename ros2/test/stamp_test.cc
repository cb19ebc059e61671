// SPDX-License-Identifier: Apache-2.0
#include "ros2/stamp.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gaitd::ros2 {
namespace {

void expect(const Stamp& stamp, std::int32_t sec, std::uint32_t nanosec) {
  EXPECT_EQ(stamp.sec, sec);
  EXPECT_EQ(stamp.nanosec, nanosec);
}

TEST(Stamp, FractionsCountUpwardsBeforeTheEpochToo) {
  expect(to_stamp(std::int64_t{1'500'000'001}), 1, 500'000'001);
  expect(to_stamp(std::int64_t{-1}), -1, 999'999'999);
  expect(to_stamp(std::int64_t{-2'000'000'000}), -2, 0);
}

TEST(Stamp, TicksRoundToTheNanosecond) {
  expect(to_stamp(12.345), 12, 345'000'000);
  expect(to_stamp(0.9999999999), 1, 0);
}

TEST(Stamp, WhatDoesNotFitIsBounded) {
  expect(to_stamp(1e300), 2147483647, 999'999'999);
  expect(to_stamp(-1e300), -2147483648, 0);
  expect(to_stamp(NAN), 0, 0);
}

TEST(Stamp, NowIsNow) {
  EXPECT_NEAR(static_cast<double>(now().sec), static_cast<double>(std::time(nullptr)), 2.0);
}

}  // namespace
}  // namespace gaitd::ros2
