// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/hang_guard.h"

#include <gtest/gtest.h>

namespace gaitd::daemon {
namespace {

using Verdict = HangGuard::Verdict;

constexpr double kPeriod = 0.05;  // s

int looks(double seconds) { return static_cast<int>(seconds / kPeriod + 0.5); }

// How many looks at a loop that stays in a plugin come before this verdict; -1: it never does.
int looks_before(HangGuard& guard, Verdict wanted, bool stop_requested) {
  for (int i = 0; i < looks(100.0); ++i) {
    if (guard.look(7, true, stop_requested) == wanted) return i;
  }
  return -1;
}

TEST(HangGuard, ALoopThatGoesRoundRuns) {
  HangGuard guard(kPeriod, true);
  for (std::uint64_t round = 0; round < 5000; ++round) {
    ASSERT_EQ(guard.look(round, true, true), Verdict::kRuns);
  }
}

TEST(HangGuard, AHangIsToldOnceAndAgainIfItComesAgain) {
  HangGuard guard(kPeriod, false);
  EXPECT_EQ(looks_before(guard, Verdict::kHangs, false), looks(HangGuard::kTell));
  EXPECT_EQ(looks_before(guard, Verdict::kHangs, false), -1);
  EXPECT_EQ(guard.look(8, true, false), Verdict::kRuns);
  EXPECT_EQ(looks_before(guard, Verdict::kHangs, false), looks(HangGuard::kTell));
}

TEST(HangGuard, AStopDoesNotWaitForAPlugin) {
  HangGuard guard(kPeriod, false);
  EXPECT_EQ(looks_before(guard, Verdict::kGiveUp, true), looks(HangGuard::kAsked));
}

TEST(HangGuard, OnlyInLockstepDoesItEndByItself) {
  HangGuard realtime(kPeriod, false);
  EXPECT_EQ(looks_before(realtime, Verdict::kGiveUp, false), -1);
  HangGuard lockstep(kPeriod, true);
  EXPECT_EQ(looks_before(lockstep, Verdict::kGiveUp, false), looks(HangGuard::kLockstep));
}

// A disk, or the library of a swap.
TEST(HangGuard, WaitingOutsideAPluginIsNoHang) {
  HangGuard guard(kPeriod, true);
  for (int i = 0; i < looks(100.0); ++i) {
    ASSERT_EQ(guard.look(7, false, true), Verdict::kRuns);
  }
}

TEST(HangGuard, ALoopThatHasNotBegunDoesNotHang) {
  HangGuard guard(kPeriod, true);
  for (int i = 0; i < looks(100.0); ++i) ASSERT_EQ(guard.look(0, true, true), Verdict::kRuns);
}

}  // namespace
}  // namespace gaitd::daemon
